"""Joints that remain open when an assembly does not close.

The linear equations of joints are eliminated, so they always hold, and what stays open are the shapes of the bodies.
An engineer thinks the other way round: bodies are rigid and joints gape.
"""

import numpy as np
from numpy.typing import NDArray

from mbs.model.body import Body
from mbs.model.model import Model

Array = NDArray[np.float64]


def joint_gaps(model: Model, q_full: Array) -> dict[str, float]:
    """Gap of each joint whose equations are linear, m, with every body rigid again next to where `q_full` has it."""
    rigid = np.array(q_full, dtype=float)
    for body in model.bodies:
        if not body.is_point:
            frame = 12 if body.is_flexible else body.size
            axes = slice(body.start + body.dimension, body.start + frame)
            rigid[axes] = _rigid_axes(body, rigid[axes])
    gaps = {}
    for joint in model.joints:
        if joint.switch is not None and not joint.switch.on:
            continue
        values = [e.linear_form().value(rigid) for e in joint.equations if e.is_linear]
        gaps[joint.name] = float(np.linalg.norm(values)) if values else 0.0
    return gaps


def joints_of_bodies(model: Model) -> dict[str, list[str]]:
    """Names of the joints at each body, by its name."""
    owner = {i: body.name for body in model.bodies for i in range(body.start, body.start + body.size)}
    joint_names: dict[str, list[str]] = {body.name: [] for body in model.bodies}
    for joint in model.joints:
        terms = {
            i
            for e in joint.equations
            for expression in (e.linear, *(factor for product in e.products for factor in product[1:]))
            for i in expression.terms
        }
        for name in sorted({owner[i] for i in terms if i in owner}):
            joint_names[name].append(joint.name)
    return joint_names


def _rigid_axes(body: Body, axes: Array) -> Array:
    """The unit, perpendicular axes nearest to those given, as full coordinates."""
    if body.dimension == 2:
        length = float(np.linalg.norm(axes))
        return axes / length if length > 0.0 else np.array([1.0, 0.0])
    U, _, Vt = np.linalg.svd(axes.reshape(3, 3))
    U[:, 2] *= np.sign(np.linalg.det(U @ Vt))
    return np.array(U @ Vt).ravel()
