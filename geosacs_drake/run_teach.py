"""Teach demonstrations in the simulation, learn a canal from them, and travel it."""

from geosacs_drake.teach.run import main

if __name__ == "__main__":
    main()
