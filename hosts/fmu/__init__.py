"""FMUs through FMI: variables, settings, drawings, other names of variables."""
