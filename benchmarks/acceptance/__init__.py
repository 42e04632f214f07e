"""What was shown stays shown: the lines that tests are too short for, in one table (`make acceptance`).

A *check* is a list of jobs, each a process of its own, and of lines that say what their figures must be.
"""
