"""Torsional stiffness and natural frequencies of the frame of a car."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.fixed_interface import FixedInterface
from mbs.flexible.frequencies import natural_modes
from mbs.vehicle import Car

COUPLE = 1e3  # N m; the frame is linear
RIGID = 6  # rigid-body modes
MODES = 4  # elastic modes
PAIR = np.array([1.0, -1.0])  # left, right: forces of a couple, and signs of the displacements in a twist


@dataclass(frozen=True)
class Stiffness:
    """Result of `stiffness`."""

    joints: tuple[str, str]
    """Left joints that take the couples, front and rear: the highest of each axle."""
    torsion: float
    """Couple divided by the twist angle between the axles, N m/deg."""
    frequencies: NDArray[np.float64]
    """Elastic natural frequencies of the free frame with all masses on it, Hz."""


def stiffness(car: Car) -> Stiffness:
    """Torsional stiffness of the free frame by opposite couples at the axles, and its lowest natural frequencies.

    `car`: car with a flexible frame.
    """
    model = car.flexible_frame.model
    joints = _left_joints(car)
    dofs = [_vertical_dofs(model, place) for place in joints.values()]
    widths = [2.0 * float(place[1]) for place in joints.values()]
    load = np.zeros((model.n_dof, 1))
    for dof, width, sign in zip(dofs, widths, (1.0, -1.0), strict=True):
        load[dof, 0] = sign * COUPLE / width * PAIR
    # the couples balance each other: the support has no reaction
    displacements = FixedInterface(model, car.flexible_frame.reference, ()).solve(load)[:, 0]
    front, rear = (float(PAIR @ displacements[dof]) / width for dof, width in zip(dofs, widths, strict=True))
    hertz, _ = natural_modes(model, RIGID + MODES)
    front_joint, rear_joint = joints
    return Stiffness((front_joint, rear_joint), COUPLE / float(np.degrees(front - rear)), hertz[RIGID:])


def _left_joints(car: Car) -> dict[str, NDArray[np.float64]]:
    """The highest left joint of the front and of the rear axle, with their places, m."""
    frame = car.flexible_frame
    middle = 0.5 * (car.front.wheel.centre[0] + car.rear.wheel.centre[0])
    left = {name: frame.place(name) for name in frame.interfaces if frame.place(name)[1] > 0.0}
    axles = ([n for n, place in left.items() if (place[0] > middle) == is_front] for is_front in (True, False))
    highest = (max(names, key=lambda n: float(left[n][2])) for names in axles)
    return {name: left[name] for name in highest}


def _vertical_dofs(model: FiniteElementModel, point: NDArray[np.float64]) -> NDArray[np.int64]:
    """Degrees of freedom along z of the node at a point and of its mirror image."""
    node_indices = [
        int(np.linalg.norm(model.positions - point * [1.0, side, 1.0], axis=1).argmin()) for side in (1.0, -1.0)
    ]
    return np.array(model.dof[node_indices, 2])
