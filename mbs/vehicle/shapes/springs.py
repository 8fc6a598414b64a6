"""Shapes of springs and dampers: coils around telescopic dampers."""

import math

from mbs.vehicle.shapes.appearance import CHROME, SPRING_PAINT, Anchor, Looks

COIL_RADIUS, WIRE_DIAMETER, DAMPER_RADIUS = 0.046, 0.011, 0.020  # m, of a small car
COIL_PITCH = 0.038  # m from coil to coil
MAX_SPRING_LENGTH = 0.42  # m: a longer distance is drawn with a spring seat on the tube of the damper


def draw_spring_and_damper(looks: Looks, name: str, lower: Anchor, upper: Anchor) -> None:
    """Draw a coil spring around its damper. `lower`, `upper`: its ends."""
    draw_damper(looks, lower, upper)
    length = math.dist(lower[1], upper[1])
    draw_coil(looks, name, lower, upper, seat=max(length - MAX_SPRING_LENGTH, 0.0))


def draw_coil(looks: Looks, name: str, lower: Anchor, upper: Anchor, seat: float = 0.0) -> None:
    """Draw a coil spring whose coil begins at a distance `seat`, m, from its lower end."""
    scale = looks.scale
    coils = max(3, round((math.dist(lower[1], upper[1]) - seat) / (scale * COIL_PITCH)))
    looks.shape(
        lower[0],
        "spring",
        ends=(lower, upper),
        radius=scale * COIL_RADIUS,
        wire=scale * WIRE_DIAMETER,
        coils=coils,
        seat=seat or None,
        name=name,
        **SPRING_PAINT,
    )


def draw_damper(looks: Looks, lower: Anchor, upper: Anchor) -> None:
    """Draw a telescopic damper."""
    looks.shape(lower[0], "damper", ends=(lower, upper), radius=looks.scale * DAMPER_RADIUS, **CHROME)
