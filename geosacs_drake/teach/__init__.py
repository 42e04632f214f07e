"""The lesson: a person records demonstrations in the simulation, and a canal is learned from them at once."""
