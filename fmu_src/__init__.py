"""The FMI face of a System: its table of variables, its model description and what carries it into a host."""
