"""Cases and rivals of the inverse kinematics, and its fuzz."""
