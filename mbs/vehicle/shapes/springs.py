"""Looks of springs and dampers: coils that compress around rods that slide."""

import math

from mbs.vehicle.shapes.appearance import COIL, POLISHED, Anchor, Looks

COIL_RADIUS, WIRE, DAMPER_RADIUS = 0.046, 0.011, 0.020  # m, of a small car
PITCH = 0.038  # m from coil to coil
LONGEST = 0.42  # m: longer springs are drawn with a seat on the tube of the damper, which turns with it


def spring_and_damper(looks: Looks, name: str, lower: Anchor, upper: Anchor) -> None:
    """A coil spring around its damper. `lower`, `upper`: its ends."""
    damper(looks, lower, upper)
    length = math.dist(lower[1], upper[1])
    coil(looks, name, lower, upper, seat=max(length - LONGEST, 0.0))


def coil(looks: Looks, name: str, lower: Anchor, upper: Anchor, seat: float = 0.0) -> None:
    """A coil spring alone, whose coil begins at `seat`, m from its lower end."""
    scale = looks.scale
    coils = max(3, round((math.dist(lower[1], upper[1]) - seat) / (scale * PITCH)))
    looks.shape(
        lower[0],
        "spring",
        ends=(lower, upper),
        radius=scale * COIL_RADIUS,
        wire=scale * WIRE,
        coils=coils,
        seat=seat or None,
        name=name,
        **COIL,
    )


def damper(looks: Looks, lower: Anchor, upper: Anchor) -> None:
    """A telescopic damper."""
    looks.shape(lower[0], "damper", ends=(lower, upper), radius=looks.scale * DAMPER_RADIUS, **POLISHED)
