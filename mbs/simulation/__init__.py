"""Stepping a System: by hand with `Simulation`, or a whole run with `simulate`."""
