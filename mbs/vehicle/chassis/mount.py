"""What the rest of the car needs of the chassis, whatever its fidelity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbs.affine import AffineVector
from mbs.model.body import Body


@dataclass(frozen=True)
class Mount:
    """The chassis in a model.

    Attributes
    ----------
    body : Body
        What joints and springs take.
    frame : Body
        Rigid body, or floating frame: axes and points that do not deform.
    origin : tuple of float
        The reference point in the drawing, m.
    accelerated : Body
        Where accelerometers sit.
    drive_axes : tuple of AffineVector
        z and x axes that take the reaction of the drive.
    contact_frame : tuple of AffineVector, list of AffineVector, ndarray
        Origin, axes and place of the origin in the drawing, m, that take the forces of the ground on the chassis.
    """

    body: Body
    frame: Body
    accelerated: Body
    origin: tuple[float, float, float]
    drive_axes: tuple[AffineVector, AffineVector]
    contact_frame: tuple[AffineVector, list[AffineVector], np.ndarray]
