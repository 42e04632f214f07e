"""The operator's console: one page with the robot in it, and a link to the robot that can be trusted."""
