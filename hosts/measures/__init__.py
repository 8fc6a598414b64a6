"""Measures of a car's motion, computed from recorded signals."""
