"""Standard tests of cars, done with an FMU through FMI alone."""
