"""Measured errors and cost of the levels (fidelity and step) of a car, and the cheapest level within tolerances."""
