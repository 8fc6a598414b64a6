"""FMUs of a System: table of variables, model description, slaves in C and Python, archive."""
