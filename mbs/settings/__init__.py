"""Request of a run: method, tolerances, steps, inputs over time."""
