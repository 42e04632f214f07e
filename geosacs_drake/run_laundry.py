"""Load a washing machine by shared autonomy on a canal surface (paper VI, task 2)."""

from geosacs_drake.run import main

if __name__ == "__main__":
    main("laundry")
