"""Checks the mass of a frame against the mass of the chassis in the file."""

import numpy as np

from mbs.common.errors import ModelError
from mbs.flexible.body_plausibility import model_plausibility
from mbs.vehicle.chassis.frames.frame_section import Structure
from mbs.vehicle.chassis.section import Chassis

MASS_TOLERANCE = 0.005  # relative to the mass
INERTIA_TOLERANCE = 0.02  # relative to the largest moment of inertia
CENTRE_TOLERANCE = 0.005  # m
_REMEDY = "Change the masses of the frame too; what a parameter of a run changes may differ: it rides on the frame."


def check_mass(structure: Structure, chassis: Chassis) -> None:
    """Compare the mass properties of a frame, with all masses on it, with the rigid chassis.

    Raises `ModelError` if mass, centre of mass or inertia differ.
    """
    points, riding = structure.model.mass, structure.riding
    masses = np.concatenate([points.masses, list(riding.values())])
    positions = np.vstack([points.positions, *(structure.joints[joint] for joint in riding)])
    total = float(masses.sum())
    if abs(total - chassis.mass) > MASS_TOLERANCE * chassis.mass:
        (plausibility,) = model_plausibility(structure.model, modes=False, beside=chassis.mass - sum(riding.values()))
        causes = "".join(f"{sentence} " for sentence in plausibility.warnings() if "would explain it" in sentence)
        raise ModelError(
            f"{chassis.key('mass')} is {chassis.mass:g} kg, but the frame with the masses it carries has "
            f"{total:.6g} kg. {causes}{_REMEDY}"
        )
    centre = masses @ positions / total
    if np.linalg.norm(centre - chassis.com) > CENTRE_TOLERANCE:
        raise ModelError(
            f"{chassis.key('com')} is {list(chassis.com)} m, but the centre of mass of the frame with the masses it "
            f"carries is {_round(centre, 4)} m. {_REMEDY}"
        )
    arms = positions - centre
    second_moments = (masses[:, None] * arms).T @ arms
    tensor = np.trace(second_moments) * np.eye(3) - second_moments
    chassis_tensor = np.array(chassis.tensor)
    if np.abs(tensor - chassis_tensor).max() > INERTIA_TOLERANCE * chassis_tensor.max():
        (x, xy, xz), (_, y, yz), (_, _, z) = tensor
        raise ModelError(
            f"{chassis.key('inertia')} is {list(chassis.inertia)} kg.m2 and products {list(chassis.products)}, but the "
            f"frame with the masses it carries has {_round((x, y, z), 2)} and {_round((xy, xz, yz), 2)} kg.m2. "
            f"{_REMEDY}"
        )


def _round(values: object, digits: int) -> list[float]:
    """Values rounded for a message."""
    return [round(float(v), digits) + 0.0 for v in np.asarray(values)]
