"""Sensors of joints: forces and moments from the multipliers of their rows."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import AffineVector
from mbs.common.checks import number, one_of, shown
from mbs.common.errors import ModelError
from mbs.kernel.header.enumerations import SensorType
from mbs.model.body import Body
from mbs.model.joint_reactions import fold_constants, force_on_first, moment_terms, rod_terms
from mbs.model.joints.joint import SCALAR_FORCES, Joint
from mbs.model.sensor import Sensor, Term
from mbs.model.sensor_arguments import component_number, sensed_joint, sensed_joints
from mbs.model.sensors import SensorVocabulary


class JointSensorVocabulary(SensorVocabulary):
    """Calls that add sensors of forces, torques and gaps in joints."""

    def sense_joint(
        self,
        name: str,
        joint: Joint | str,
        component: str = "x",
        kind: str = "force",
        *,
        on: str = "first",
        axes: Body | str = "earth",
        point: ArrayLike | None = None,
        unit: str = "",
        description: str = "",
    ) -> Sensor:
        """Force of a joint on its first body, N, or its moment on one of its bodies, N m.

        The equations that are read stay rows of the System, so that their multipliers exist. Revolute, cylindrical,
        universal and prismatic joints and welds transmit a moment; about its own axis a joint has none. The moment of
        the drive of an angle is its torque on the angle.

        Parameters
        ----------
        component : str
            Of a force: "x", "y" or "z" in earth axes of a joint with a shared point or a line; "tension" of a distance;
            "drive" of a drive; either of a driven distance ("drive" pushes its ends apart); "torque" of a gear on its
            first wheel, N m; "force" of a rack on its body and of a screw on its first body, both along the axis. Of a
            moment: "x", "y" or "z", in the plane "z".
        kind : {"force", "moment"}
            The next three are for moments.
        on : {"first", "second"}
            The body that the moment acts on, in the order in which the joint was given its bodies.
        axes : {"earth"} or Body
            Axes of the component: fixed axes of the earth, or moving axes of a body.
        point : array_like, shape (dimension,), optional
            Place (earth axes, reference configuration, m) of the body that it acts on, about which the moment is taken;
            by default the point of the joint on that body.

        Raises
        ------
        ModelError
            The joint has no such force or moment.
        """
        one_of(kind, ("force", "moment"), f"The kind of sensor '{name}'")
        sensed = sensed_joint(self, name, joint)
        if not isinstance(on, str) or on not in ("first", "second"):
            raise ModelError(f"The sensor '{name}' asks for the {kind} on {shown(on)}; it must be 'first' or 'second'.")
        if kind == "moment" and not (sensed.type == "drive" and sensed.equations[0].kind == "drive"):
            return _joint_moment(self, name, sensed, component, on, axes, point, unit, description)
        if on != "first" or not isinstance(axes, str) or axes != "earth" or point is not None:
            raise ModelError(
                f"The sensor '{name}' reads the force of joint '{sensed.name}' on its first body in earth axes; on, "
                "axes and point are for moments."
            )
        if kind == "moment":
            return _joint_force(self, name, sensed, "drive", self._unit(unit, "N.m"), description)
        return _joint_force(self, name, sensed, component, unit, description)

    def sense_rod_force(
        self,
        name: str,
        rods: Sequence[Joint],
        body: Body,
        axis: ArrayLike,
        *,
        scale: float = 1.0,
        unit: str = "N",
        description: str = "",
    ) -> Sensor:
        """Sum of the forces of massless rods on a rigid body, along an axis of the body, N.

        Parameters
        ----------
        rods : sequence of Joint
            Distances with one end on the body.
        axis : array_like, shape (dimension,)
            Fixed in the body, earth axes in the reference configuration, of any length.
        scale : float
            Factor on it.

        Raises
        ------
        ModelError
            One of them is not a rod or ends elsewhere, or the axis is zero.
        """
        subject = f"The sensor '{name}'"
        along = self.anchor_axis(self.owned(body, subject), axis, f"sensor '{name}'")
        factor = number(scale, f"The scale of sensor '{name}'")
        terms = []
        for joint in sensed_joints(self, name, "rods", rods):
            if joint.ends is None or not joint.ends.rod or body not in joint.ends.bodies:
                raise ModelError(
                    f"{subject} needs rods that end on '{body.name}'; '{joint.name}' ({joint.type}) does not."
                )
            terms += [replace(t, weight=factor * t.weight) for t in rod_terms(joint, body, along)]
        return self._sense(name, unit, description, SensorType.REACTION_PRODUCTS, terms=terms)


def _sense_terms(
    model: SensorVocabulary, name: str, unit: str, description: str, joint: Joint, terms: Sequence[Term]
) -> Sensor:
    joint.as_rows = joint.as_rows or any(term.equation in joint.force_equations for term in terms)
    return model._sense(name, unit, description, SensorType.REACTION_PRODUCTS, joint=joint, terms=terms)


def _joint_force(
    model: SensorVocabulary, name: str, joint: Joint, component: str, unit: str, description: str
) -> Sensor:
    rows = joint.force_equations
    if not rows:
        raise ModelError(
            f"The joint '{joint.name}' ({joint.type}) has no readable force; shared points, lines, distances, "
            "drop links, drives, gears, racks and screws have one."
        )
    unit = model._unit(unit, joint.force_unit)
    if joint.equations[rows[0]].kind == "driven_distance":
        return _driven_distance_force(model, name, joint, component, unit, description)
    if joint.normals:
        k = component_number(component, model.dimension, f"sensor '{name}'")
        if any(n[k].terms for n in joint.normals):  # the line turns with its body
            terms = [t for row, w, n in force_on_first(joint) for t in fold_constants(Term(w, row, (n[k],)))]
            return _sense_terms(model, name, unit, description, joint, terms)
        rows, weights = list(rows), [-n[k].constant for n in joint.normals]
    elif joint.type in SCALAR_FORCES:
        expected = SCALAR_FORCES[joint.type]
        if component not in (expected, "x"):
            raise ModelError(
                f"The component of sensor '{name}' is {shown(component)}; for a {joint.type} it must be '{expected}'."
            )
        sign = 1.0 if expected == "tension" else -1.0
        rows, weights = rows[:1], [sign * joint.rows_weight]
    else:
        k = component_number(component, model.dimension, f"sensor '{name}'")
        rows, weights = rows[k : k + 1], [-joint.rows_weight]
    joint.as_rows = True
    return model._sense(name, unit, description, SensorType.REACTION, integers=rows, reals=weights, joint=joint)


def _driven_distance_force(
    model: SensorVocabulary, name: str, joint: Joint, component: str, unit: str, description: str
) -> Sensor:
    """Force of the row (|p1 - p2|^2 - s^2)/2 = 0: the multiplier times the length s is the tension."""
    signs = {"tension": 1.0, "drive": -1.0, "x": -1.0}
    if not isinstance(component, str) or component not in signs:
        raise ModelError(
            f"The component of sensor '{name}' is {shown(component)}; for a driven distance it must be "
            "'tension' or 'drive'."
        )
    (row,) = joint.force_equations
    term = Term(signs[component], row, (), joint.equations[row].guides[0].guide)
    return _sense_terms(model, name, unit, description, joint, [term])


def _joint_moment(
    model: SensorVocabulary,
    name: str,
    joint: Joint,
    component: str,
    on: str,
    axes: Body | str,
    point: ArrayLike | None,
    unit: str,
    description: str,
) -> Sensor:
    axis = _moment_axis(model, name, component, axes)
    about = None
    if not joint.turns:
        raise ModelError(
            f"The joint '{joint.name}' ({joint.type}) transmits no moment; revolute, cylindrical, universal and "
            "prismatic joints, welds and drives of an angle do."
        )
    if point is not None:
        if joint.places is None:
            raise ModelError(f"The moment of joint '{joint.name}' ({joint.type}) is taken at its own point only.")
        about = joint.places.bodies[on == "second"].point(point)
    terms = moment_terms(joint, joint.hold_turning(), axis, about, on == "first")
    return _sense_terms(model, name, model._unit(unit, "N.m"), description, joint, terms)


def _moment_axis(model: SensorVocabulary, name: str, component: str, axes: Body | str) -> AffineVector:
    """Axis of a moment, three components; in the plane one."""
    if model.dimension == 2:
        if component != "z":
            raise ModelError(f"The component of sensor '{name}' is {shown(component)}; in the plane it must be 'z'.")
        return AffineVector.constant([1.0])
    e = np.eye(3)[component_number(component, 3, f"sensor '{name}'")]
    if isinstance(axes, Body):
        return model.owned(axes, f"The sensor '{name}'").vector(e)
    if not isinstance(axes, str) or axes != "earth":
        raise ModelError(f"The axes of sensor '{name}' are {shown(axes)}; they must be 'earth' or a body.")
    return AffineVector.constant(e)
