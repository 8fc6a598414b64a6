"""Our names for the variables of an FMU of another program: names, units, signs, frames."""
