"""The cheapest level of a car, fidelity and step, that meets tolerances: errors and cost of each, measured."""
