"""Rigid bodies of a model: how they are added, and checks of bodies and points at joints."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mbs.common.affine import AffineVector
from mbs.common.checks import (
    capital,
    direction,
    not_negative,
    positive,
    shown,
    vector,
)
from mbs.common.errors import ModelError
from mbs.model.body import Body, same_place, size_about
from mbs.model.carried_parts import Payload, WrittenInertia
from mbs.model.inertia import inertia_matrix
from mbs.model.joint_ends import FixedEnd, body_and_point
from mbs.model.register import Register

GYRATION_LIMITS = (1e-12, 1e8)
"""Least and largest radius of gyration, m."""
ROTATION = 1e-9
"""Largest error of the entries of a rotation matrix."""


class BodyVocabulary(Register):
    """The bodies of a model."""

    def body(self, name: str, *, mass: float, com: ArrayLike, inertia: ArrayLike) -> Body:
        """A rigid body.

        Parameters
        ----------
        mass : float
            kg.
        com : array_like, shape (dimension,)
            Centre of mass in earth axes in the reference configuration, m.
        inertia : float or array_like, shape (3,) or (3, 3)
            About the centre of mass in earth axes in the reference configuration, kg m2: planar a number, spatial
            3 principal values or a 3x3 matrix.

        Raises
        ------
        ModelError
            No mass distribution has this inertia.
        """
        m = positive(mass, f"The mass of body {shown(name)}")
        centre = vector(com, self.dimension, f"the centre of mass of body {shown(name)}")
        I = inertia_matrix(inertia, self.dimension, f"The inertia of body {shown(name)}")
        _check_gyration(m, I, f"body {shown(name)}")
        # second moments of mass from moments of inertia: J = tr(I)/2 - I; planar: only the polar moment counts
        J = 0.5 * np.trace(I) * np.eye(3) - I if self.dimension == 3 else np.diag([0.5 * I[2, 2], 0.5 * I[2, 2], 0.0])
        new = Body(self, self.unique("body", name), centre, len(self.coordinates))
        new.add_mass(m, centre, J)
        self._register(new)
        return new

    def payload(
        self,
        name: str,
        body: Body,
        position: ArrayLike,
        *,
        mass: float = 0.0,
        point: AffineVector | None = None,
    ) -> Payload:
        """A point mass on a body, such as a driver, whose mass a parameter may write.

        It moves as its point of the body does and brings no coordinates: its inertia and its weight act there, in every
        method. ``m.parameter(..., targets=[(payload, "mass", 1.0)], tunable=False)`` makes its mass a fixed parameter.
        The System does not depend on its mass otherwise: what the compiler scales by masses, and how it distributes a
        start velocity that is given in part, is as without payloads.

        Parameters
        ----------
        body : Body
            Of this model, not the ground. On a flexible body it sits at a node; with ports it must sit at one of them
            where quasi-static outputs are to follow it.
        position : array_like, shape (dimension,)
            In earth axes in the reference configuration, m.
        mass : float
            kg; may be 0.
        point : AffineVector, optional
            Point that carries it instead of the body's own point there, such as a mean of several points of the body,
            which then share its force.

        Raises
        ------
        ModelError
            The body is the ground or has no such point, or `point` is drawn elsewhere.
        """
        subject = f"payload {shown(name)}"
        self.owned(body, f"The {subject}")
        m = not_negative(mass, f"The mass of {subject}")
        location = vector(position, self.dimension, f"the position of {subject}")
        if body.is_ground:
            raise ModelError(f"The {subject} sits on the ground, which does not move; give it to a body.")
        if body.is_lookup_table:
            raise ModelError(
                f"The {subject} sits on lookup-table body '{body.name}', whose mass is part of its table; give it to "
                "its base."
            )
        if point is not None:
            drawn_point = self.expressions(point, f"The {subject}").value(self.drawn())
            if not same_place(drawn_point, location, size_about(body, location)):
                raise ModelError(
                    f"The {subject} is at {location.tolist()}, but its point is drawn at {drawn_point.tolist()}."
                )
            carrier = point
        else:  # the origin of a floating frame is not a material point, a node is
            carrier = body.at(location, subject).point(location)
        return self.enter("payload", self.payloads, Payload(name, body, location, carrier, m, point is not None))

    def written_inertia(
        self,
        name: str,
        point: AffineVector,
        axes: Sequence[AffineVector],
        *,
        mass: float,
        com: ArrayLike,
        inertia: ArrayLike,
    ) -> WrittenInertia:
        """Let parameters write mass, centre of mass and inertia of a body, which has them as drawn already.

        Their changes act in every method at `point` and `axes`, as a payload does. A parameter writes to its
        ``mass``, ``com_x``, ``com_y``, ``com_z``, ``xx``, ``yy``, ``zz``, ``xy``, ``xz`` or ``yz`` and is fixed.

        Parameters
        ----------
        name : str
            For the targets of parameters.
        point : AffineVector
            The centre of mass as drawn, of the body, m.
        axes : sequence of AffineVector
            Three vectors of the body that are the axes of the drawing there.
        mass : float
            kg, as drawn.
        com : array_like, shape (3,)
            In earth axes in the reference configuration, m.
        inertia : array_like, shape (3,) or (3, 3)
            About the centre of mass, along these axes, kg m2.
        """
        subject = f"written inertia {shown(name)}"
        if self.dimension != 3:
            raise ModelError(f"The {subject} needs a spatial model.")
        m = positive(mass, f"The mass of {subject}")
        tensor = inertia_matrix(inertia, 3, f"the inertia of {subject}")
        if not isinstance(axes, (list, tuple)) or len(axes) != 3 or not all(isinstance(a, AffineVector) for a in axes):
            raise ModelError(f"The axes of {subject} are {shown(axes)}; they must be three vectors of a body.")
        x, y, z = (self.expressions(axis, f"The {subject}") for axis in axes)
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = tensor.tolist()
        centre = vector(com, 3, f"the centre of mass of {subject}").tolist()
        reals = (m, *centre, xx, yy, zz, xy, xz, yz)
        new = WrittenInertia(name, (self.expressions(point, f"The {subject}"), x, y, z), reals)
        return self.enter("written inertia", self.written_inertias, new)

    def owned(self, body: Body, subject: str) -> Body:
        """The body; raises `ModelError` if it is not of this model.

        Parameters
        ----------
        body : Body
            A body, a point mass, the ground, or a node of a flexible body.
        """
        if not isinstance(body, Body):
            raise ModelError(f"{capital(subject)} needs a body, got {shown(body)}.")
        if body.model is not self:
            raise ModelError(
                f"{capital(subject)}: body '{body.name}' belongs to model '{body.model.name}', not to '{self.name}'."
            )
        return body

    def anchor(self, body: Body, position: ArrayLike | None, subject: str) -> AffineVector:
        """Expressions of a joint point of a body, which is stored for the choice of short rows of the body.

        Parameters
        ----------
        position : array_like, shape (dimension,)
            In earth axes in the reference configuration, m; of a point mass None.
        """
        self.owned(body, subject)
        if body.is_point:
            return body.point(position)  # type: ignore[arg-type]
        local = vector(position, self.dimension, f"the point of {subject} on body '{body.name}'")
        self.remember(body)
        self.grounded = self.grounded or body.is_ground
        body.joint_points.append(local - body.com)
        return body.point(local)

    def anchor_axis(self, body: Body, axis: ArrayLike, subject: str) -> AffineVector:
        """Expressions of a unit joint axis of a body, which is stored like a joint point.

        Parameters
        ----------
        axis : array_like, shape (dimension,)
            In earth axes in the reference configuration, of any length.

        Returns
        -------
        AffineVector
            The unit vector.

        Raises
        ------
        ModelError
            The body has no axes, or the axis is zero.
        """
        self.owned(body, subject)
        unit = direction(axis, self.dimension, f"the axis of {subject} on body '{body.name}'")
        if body.flexibility is not None:
            raise ModelError(
                f"The {subject} needs an axis of flexible body '{body.name}': name the node, "
                f"{body.name}.interface(node)."
            )
        if body.is_ground:
            self.grounded = True
        elif not body.is_point:
            self.remember(body)
            body.joint_axes.append(unit)
        return body.vector(unit)

    def _end(self, end: FixedEnd, subject: str) -> AffineVector:
        """Point of a body at which a force acts."""
        body, point = body_and_point(end, subject)
        return self.owned(body, f"The {subject}").point(point)

    def _register(self, body: Body) -> None:
        self.coordinates += body.coordinates()
        body.number = len(self.bodies)
        self.bodies.append(body)


def _check_gyration(mass: float, inertia: NDArray[np.float64], subject: str) -> None:
    """Raise `ModelError` for mass and inertia whose radius of gyration is outside `GYRATION_LIMITS`."""
    radius = float(np.sqrt(np.max(np.abs(inertia)) / mass))
    if not GYRATION_LIMITS[0] <= radius <= GYRATION_LIMITS[1]:
        raise ModelError(
            f"The inertia {np.max(np.abs(inertia)):g} kg m2 of {subject} and its mass {mass:g} kg are those of "
            f"something {radius:.1g} m in size; between {GYRATION_LIMITS[0]:g} and {GYRATION_LIMITS[1]:g} m were "
            "expected."
        )
