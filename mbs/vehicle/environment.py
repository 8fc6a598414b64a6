"""Environment of every car: the acceleration of gravity."""

GRAVITY = 9.81
"""m/s2"""
