"""What a run is asked for: method, tolerances, steps, inputs over time."""
