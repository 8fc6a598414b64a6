"""The table of the variables of an FMU, its units, arrays and texts."""
