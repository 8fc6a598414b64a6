"""What a car looks like, drawn from its hard points and dimensions: no part of its motion."""
