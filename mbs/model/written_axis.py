"""Wheels whose axis parameters turn on its carrier."""

from __future__ import annotations

from math import asin, atan2

from mbs.common.checks import instance_of, number, shown
from mbs.common.errors import ModelError
from mbs.model.carried import Spin, WrittenAxis
from mbs.model.core import ModelCore

STEEPEST = 1.4
"""rad of elevation, as in `mbs/kernel/src/system/turned.c`."""


def new_written_axis(model: ModelCore, spin: Spin, leaning: float) -> WrittenAxis:
    """Register it; see `Model.written_axis`."""
    what = "wheel of Model.written_axis"
    wheel = instance_of(Spin, spin, f"The {what}", "what Model.spin returned")
    if not any(wheel is known for known in model.spins):
        raise ModelError(f"The {what}, {shown(wheel.name)}, is not of this model.")
    grows = number(leaning, f"The leaning of the {what}")
    x, y, z = wheel.axis_reference
    if abs(asin(min(max(z, -1.0), 1.0))) > STEEPEST:
        raise ModelError(f"The axis of the {what} '{wheel.name}' stands upright; its azimuth is not known.")
    name = model.unique("written axis", wheel.name)
    frame = tuple(wheel.carrier.vector(axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    new = WrittenAxis(name, wheel, (frame[0], frame[1], frame[2]), (atan2(-x, y), asin(z)), grows)
    model.written_axes.append(new)
    return new
