"""Axisymmetric wheels with their absolute axial rate as coordinate, and their axes, which parameters change."""

from math import asin, atan2

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import direction, instance_of, not_negative, number, positive, shown, vector
from mbs.common.errors import ModelError
from mbs.elements.gyroscopic_spin import GyroscopicSpin
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.carried_parts import Spin, WrittenAxis
from mbs.model.perpendicular_vectors import perpendicular

MAX_ELEVATION = 1.4
"""Largest elevation of an axis, rad, as in `mbs/kernel/src/system/parametric_axes.c`."""


def _copy(vector: AffineVector) -> AffineVector:
    """A copy of a vector, so that equal vectors of the carrier do not change with the axis."""
    return AffineVector(tuple(Affine(c.terms, c.constant) for c in vector.components))


class SpinVocabulary(BodyVocabulary):
    """Vocabulary of wheels with one coordinate each."""

    def spin(
        self,
        name: str,
        *,
        carrier: Body,
        centre: ArrayLike,
        axis: ArrayLike,
        mass: float,
        spin_inertia: float,
        diametral_inertia: float,
        rolling_radius: float = 0.0,
    ) -> Spin:
        """An axisymmetric wheel as one coordinate, its absolute axial rate.

        Mass and diametral inertia are added to the carrier.

        Parameters
        ----------
        name : str
            Name of the coordinate; unique among the spins.
        carrier : Body
            A rigid body of a spatial model.
        centre, axis : array_like, shape (3,)
            Earth axes in the reference configuration, m and of any length.
        mass : float
            kg.
        spin_inertia, diametral_inertia : float
            About the axis and across it, kg m2.
        rolling_radius : float
            Radius that gives the spin when an initial pose has a speed, m; 0: none.

        Raises
        ------
        ModelError
            The model is planar, the carrier is not rigid, or the inertias are impossible for a wheel.
        """
        subject = f"spin '{name}'"
        if self.dimension == 2:
            raise ModelError(f"The {subject} needs a spatial model; in the plane a wheel is a body.")
        self.owned(carrier, f"The {subject}")
        if carrier.is_ground or carrier.is_point or carrier.is_flexible:
            raise ModelError(f"The carrier of {subject} must be a rigid body, not '{carrier.name}'.")
        m = positive(mass, f"The mass of {subject}")
        I_s = positive(spin_inertia, f"The spin inertia of {subject}")
        I_d = not_negative(diametral_inertia, f"The diametral inertia of {subject}")
        if I_s > 2.0 * I_d * (1.0 + 1e-9):
            raise ModelError(
                f"The spin inertia {I_s:g} of {subject} is more than twice its diametral inertia {I_d:g}; no wheel has "
                "that."
            )
        radius = not_negative(rolling_radius, f"The rolling radius of {subject}")
        e = direction(axis, 3, f"the axis of {subject}")
        c = vector(centre, 3, f"the centre of {subject}")
        x, y = perpendicular(e)
        self.remember(carrier)
        carrier.joint_axes.append(e)
        # I = I_d (1 - e e'), zero about the axis, has the second moment J = tr(I)/2 - I = I_d e e'
        carrier.add_mass(m, c, I_d * np.outer(e, e))
        index = self.new_coordinate(self.unique("spin", name), "spin", 0.0)
        self.inertias[index] = I_s
        axis_vector, f, g = (_copy(carrier.vector(v)) for v in (e, x, y))
        new = Spin(
            name,
            index,
            "rad",
            carrier,
            carrier.point(c),
            axis_vector,
            f,
            g,
            I_s,
            I_d,
            radius,
            (tuple(x), tuple(y), tuple(e)),
        )
        self.add(GyroscopicSpin(I_s).record(f"{name}.gyroscopic", new.f, new.g, new.affine))
        self.spins.append(new)
        return new

    def written_axis(self, spin: Spin, *, leaning: float = 0.0) -> WrittenAxis:
        """Let parameters turn the axis of a wheel on its carrier, about the centre of the wheel.

        A parameter writes to its ``azimuth``, the angle of the axis about the vertical of the drawing from y to -x, or
        its ``elevation`` above the level there, both in rad, and is fixed. Steps cost nothing while both are as drawn.

        Parameters
        ----------
        spin : Spin
            The wheel, made by `Model.spin`.
        leaning : float
            Growth of its rolling radius with 1/cos(elevation), m: a hub that stays at its height is farther from the
            point at which a leaning wheel stands.

        Raises
        ------
        ModelError
            The axis stands upright.
        """
        subject = "wheel of Model.written_axis"
        wheel = instance_of(Spin, spin, f"The {subject}", "what Model.spin returned")
        if not any(wheel is other for other in self.spins):
            raise ModelError(f"The {subject}, {shown(wheel.name)}, is not of this model.")
        growth = number(leaning, f"The leaning of the {subject}")
        x, y, z = wheel.axis_reference
        if abs(asin(min(max(z, -1.0), 1.0))) > MAX_ELEVATION:
            raise ModelError(f"The axis of the {subject} '{wheel.name}' is vertical; its azimuth is not defined.")
        frame = tuple(wheel.carrier.vector(axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
        new = WrittenAxis(wheel.name, wheel, (frame[0], frame[1], frame[2]), (atan2(-x, y), asin(z)), growth)
        return self.enter("written axis", self.written_axes, new)
