"""What all programs share: errors, numbers, options of the command line, units."""
