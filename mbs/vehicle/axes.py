"""Axes of the drawing and of the vehicle, after ISO 8855."""

FORWARD, LEFT, UP = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
