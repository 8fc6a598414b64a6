"""Shapes of an anti-roll bar: a bar between its bushes, levers that turn, and links to the suspension."""

from mbs.vehicle.axes import LEFT
from mbs.vehicle.axle import Axle
from mbs.vehicle.shapes.appearance import BARE_STEEL, CAST_STEEL, Looks
from mbs.vehicle.side import sides

MODEL_NAMES = {"half": "half axle"}  # parts of a suspension whose bodies have another name in the model


def anti_roll_bar_shapes(looks: Looks, name: str, axle: Axle) -> None:
    """Draw the anti-roll bar of an axle, if it has one."""
    bar = axle.anti_roll_bar
    if bar is None:
        return
    pivots = []
    for side in sides(name):
        w = side.wheel
        pivot, lever_end, link_end = (
            side.point(point) for point in (bar.points.pivot, bar.points.lever_end, bar.points.link_end)
        )
        link_body = looks.body(f"{MODEL_NAMES.get(bar.part, bar.part.replace('_', ' '))} {w}")
        lever = looks.m.turning(
            f"anti-roll lever {w}", looks.chassis, at=pivot, axis=LEFT, angle=f"anti_roll_bar_{w}.angle"
        )
        looks.tube((lever, pivot), (lever, lever_end), radius=0.010, **BARE_STEEL)
        looks.tube((lever, lever_end), (link_body, link_end), radius=0.006, name=f"anti-roll link {w}", **CAST_STEEL)
        for owner, position in ((lever, lever_end), (link_body, link_end), (looks.chassis, pivot)):
            looks.ball((owner, position), 0.013)
        pivots.append((looks.chassis, pivot))
    looks.tube(*pivots, radius=0.010, name=f"anti-roll bar {name}", **BARE_STEEL)
