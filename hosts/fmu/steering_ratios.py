"""Parameters of a car's FMU that change how far its steering wheel turns to full lock."""

RATIOS = {"steering.rack_per_turn": -1.0, "steering.ratio": 1.0}
"""By name the power with which the angle at full lock goes: travel of the rack per turn, ratio of a steering box."""
