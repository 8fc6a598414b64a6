"""Outputs of the poses of all bodies of a model, from which its motion can be drawn."""

import re

from mbs.model.body import Body
from mbs.model.flexible import FlexibleBody
from mbs.model.model import Model


def pose_outputs(model: Model) -> None:
    """Add position and quaternion of every body, and the angle of every wheel that is not a body.

    The names are `body.NAME.x` to `.z`, m, of the centre of mass as drawn, `body.NAME.qw` to `.qz`, scalar first, and
    `body.NAME.angle`; NAME is that in the model, with underscores for all but letters and digits. Planar bodies have
    z = 0 and turn about z, particles do not turn. Flexible bodies also have the outputs of `bending_outputs`.

    `model`: not compiled yet.
    """
    sensed = {sensor.name for sensor in model.sensors}
    for body in model.bodies:
        stem = _stem(body.name, sensed, ("x", "qw"))
        moving = body.frame
        _add_position(model, body.name, moving, stem)
        _add_orientation(model, body.name, moving, stem)
        sensed |= {f"{stem}.x", f"{stem}.qw"}
    for spin in model.spins:
        stem = _stem(spin.name, sensed, ("angle",))
        text = f"angle by which {spin.name} has turned on its carrier since the start, not wrapped"
        model.sense_angle(f"{stem}.angle", spin, description=text)
        sensed.add(f"{stem}.angle")
    bending_outputs(model)


def bending_outputs(model: Model) -> None:
    """Add the amplitudes of every flexible body, from which its deformation and stress can be drawn.

    The names are `body.NAME.mode_1`, `body.NAME.mode_2` and so on, unless `model.more_poses` adds others. `model`: not
    compiled yet.
    """
    sensed = {sensor.name for sensor in model.sensors}
    for add_outputs in model.more_poses:
        model.flexible_scene += add_outputs()
    if not model.more_poses:
        for body in model.bodies:
            if isinstance(body, FlexibleBody):
                _add_amplitudes(model, body, sensed)


def _add_amplitudes(model: Model, body: FlexibleBody, sensed: set[str]) -> None:
    """Add the amplitudes of the modes of a flexible body."""
    stem = _stem(body.name, sensed, ("mode_1",))
    for k, mode in enumerate(body.reduced.mode_names):
        row = [float(j == k) for j in range(body.n_modes)]
        model.sense_coordinate(
            f"{stem}.mode_{k + 1}",
            body.combination(row),
            unit="1",
            description=f"amplitude of mode '{mode}' of {body.name}",
        )


def _stem(name: str, names: set[str], parts: tuple[str, ...]) -> str:
    """First part of the outputs of a body, for which none of `parts` is among the `names` of sensors."""
    word = re.sub(r"\W", "_", name, flags=re.ASCII)
    word, k = word if word[:1].isalpha() else f"_{word}", 2
    stem = f"body.{word}"
    while any(f"{stem}.{part}" in names for part in parts):
        stem, k = f"body.{word}_{k}", k + 1
    return stem


def _add_position(model: Model, body_name: str, body: Body, stem: str) -> None:
    """Add the coordinates of the centre of mass; constant outside the plane of a planar model."""
    position = body.point(body.com)
    for k, c in enumerate("xyz"):
        name, text = f"{stem}.{c}", f"{c} of the centre of mass of {body_name} as drawn, earth"
        if k < model.dimension:
            model.sense_coordinate(name, position[k], unit="m", description=text)
        else:
            model.sense_constant(name, 0.0, unit="m", description=text)


def _add_orientation(model: Model, body_name: str, body: Body, stem: str) -> None:
    """Add the quaternion; constant for a particle."""
    for k, c in enumerate("wxyz"):
        name = f"{stem}.q{c}"
        text = f"q{c} of the orientation of {body_name} since the drawing, scalar first (qw), to earth axes"
        if body.is_point:
            model.sense_constant(name, float(k == 0), unit="1", description=text)
        else:
            model.sense_rotation(name, body, c, description=text)
