"""A pair of gears: two wheels turn against their carriers in a constant ratio."""

from mbs.common.checks import not_zero
from mbs.common.errors import ModelError
from mbs.model.bodies import BodyVocabulary
from mbs.model.carried_parts import Spin
from mbs.model.coordinate import Coordinate
from mbs.model.equation import Equation
from mbs.model.joints.joint import Joint
from mbs.model.joints.transmission import rotation_from_drawn, turning_rate


def gear(model: BodyVocabulary, name: str, wheel_1: Coordinate, wheel_2: Coordinate, *, ratio: float) -> Joint:
    """Two wheels that turn in a constant ratio.

    The equation is ``theta_1 = ratio * theta_2`` with angles from the drawing, against the carriers, which therefore
    take the reactions; with a spin, the same for the rates.

    Parameters
    ----------
    wheel_1, wheel_2 : Coordinate
        Relative angles of the wheels against their carriers, or spins.
    ratio : float
        Turns of the first wheel for one of the second, each against its carrier; negative if they turn opposite
        ways about the axes of their angles (-z2/z1 for external teeth on parallel axes).

    Returns
    -------
    Joint
        For sensors: its torque on the first wheel.

    Raises
    ------
    ModelError
        The ratio is zero, or the wheels are the same.
    """
    subject = f"gear '{name}'"
    a, b = (model.owned_coordinate(wheel, f"The {subject}") for wheel in (wheel_1, wheel_2))
    if a.index == b.index:
        raise ModelError(f"The {subject} couples '{a.name}' with itself; it needs two wheels.")
    i = not_zero(ratio, f"The ratio of {subject}")
    if isinstance(a, Spin) or isinstance(b, Spin):
        equation = Equation(name, "gear", rates=[*turning_rate(a, 1.0), *turning_rate(b, -i)])
    else:
        equation = Equation(name, "gear", linear=rotation_from_drawn(model, a) - rotation_from_drawn(model, b) * i)
    joint = Joint(name, "gear", [equation], rows_weight=1.0)
    joint.force_unit = "N m"
    joint.as_rows, joint.couples = True, (a.index, b.index, i)  # angles are never eliminated
    return joint
