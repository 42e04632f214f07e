"""Move an apple, a cup and a cube from table to table by shared autonomy on a canal surface (paper VI, task 1)."""

from geosacs_drake.run import main

if __name__ == "__main__":
    main("relocation")
