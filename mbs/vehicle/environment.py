"""What surrounds every car."""

GRAVITY = 9.81
"""m/s2"""
