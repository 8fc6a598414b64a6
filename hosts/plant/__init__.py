"""A car as a plant in a program of one's own: stepped, read, saved and restored, and environments of Gymnasium."""

from hosts.plant.car import Car
from hosts.plant.lane import Lane

__all__ = ["Car", "Lane"]
