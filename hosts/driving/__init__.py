"""Manoeuvres and drivers, and the co-simulation that runs them."""
