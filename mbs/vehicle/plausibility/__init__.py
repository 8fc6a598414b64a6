"""Plausibility of a car file: characteristic numbers of the car, with usual ranges."""
