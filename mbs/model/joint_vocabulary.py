"""More joints by name: thin wrappers around the functions of `mbs.model.joints`."""

from __future__ import annotations

from numpy.typing import ArrayLike

from mbs.model.body import Body
from mbs.model.carried import Spin
from mbs.model.ends import PointPair
from mbs.model.joints.joint import Joint
from mbs.model.joints.pin import pin
from mbs.model.joints.prismatic import prismatic
from mbs.model.joints.revolute import revolute
from mbs.model.joints.rolling import rolling, skate
from mbs.model.joints.universal import universal
from mbs.model.joints.weld import weld
from mbs.model.mechanism import Mechanism


class JointVocabulary(Mechanism):
    """Joints as those of `LinkVocabulary`."""

    def revolute(
        self, name: str, body_1: Body, body_2: Body, *, point: PointPair, axis: PointPair | None = None
    ) -> Joint:
        """Revolute joint: the bodies share a point and, in space, an axis.

        Parameters
        ----------
        body_1, body_2 : Body
            Bodies, the ground, or nodes of flexible bodies.
        point : array_like, shape (dimension,), or pair of them
            Earth axes in the reference configuration, m; a pair is one point per body.
        axis : array_like, shape (3,), or pair of them, optional
            Of any length; in space only.

        Raises
        ------
        ModelError
            The bodies are the same, or the axis is missing in space or given in the plane.
        """
        return self._join(revolute(self, name, body_1, body_2, point, axis))

    def universal(
        self, name: str, body_1: Body, body_2: Body, *, point: PointPair, axis_1: ArrayLike, axis_2: ArrayLike
    ) -> Joint:
        """Universal joint: the bodies share a point, and the angle between an axis of each is constant.

        Parameters
        ----------
        body_1, body_2 : Body
            Bodies, the ground, or nodes of flexible bodies of a spatial model.
        point : array_like, shape (3,), or pair of them
            Earth axes in the reference configuration, m; a pair is one point per body.
        axis_1, axis_2 : array_like, shape (3,)
            Axis fixed in body 1 and axis fixed in body 2, of any length and not parallel.

        Raises
        ------
        ModelError
            The model is planar, the bodies are the same, or the axes are parallel.
        """
        return self._join(universal(self, name, body_1, body_2, point, axis_1, axis_2))

    def prismatic(
        self: Mechanism, name: str, body_1: Body, body_2: Body, *, axis: ArrayLike, point: PointPair | None = None
    ) -> Joint:
        """Prismatic joint: the bodies share their orientation, and body 1 slides along an axis of body 2.

        Parameters
        ----------
        body_1, body_2 : Body
            Bodies, the ground, or nodes of flexible bodies.
        axis : array_like, shape (dimension,)
            Direction of the slide, fixed in body 2, of any length.
        point : array_like, shape (dimension,), or pair of them, optional
            Point of body 1 on the axis, m; by default the centre of mass of body 1, of body 2 where body 1 is the
            ground.

        Raises
        ------
        ModelError
            The bodies are the same or have no axes.
        """
        return self._join(prismatic(self, name, body_1, body_2, point, axis))

    def weld(self, name: str, body_1: Body, body_2: Body) -> Joint:
        """Weld: the bodies move as one.

        Parameters
        ----------
        body_1, body_2 : Body
            Bodies, point masses, the ground, or nodes of flexible bodies.
        """
        return self._join(weld(self, name, body_1, body_2))

    def pin(self, name: str, body: Body, point: ArrayLike | None = None, *, on: bool = False) -> Joint:
        """Hold a point of a body by a switch of the same name, which a running `Simulation` turns on and off.

        The point stays where it is when the switch is turned on.

        Parameters
        ----------
        body : Body
            A body or a point mass that can move.
        point : array_like, shape (dimension,), optional
            Earth axes in the reference configuration, m; by default the centre of mass.
        on : bool
            Whether it holds from the start, where it is drawn.

        Raises
        ------
        ModelError
            The body is the ground.
        """
        return self._join(pin(self, name, body, point, on))

    def rolling(
        self,
        name: str,
        wheel: Body | Spin,
        *,
        radius: float,
        centre: ArrayLike | None = None,
        axis: ArrayLike | None = None,
        level: float = 0.0,
    ) -> Joint:
        """A wheel with a knife edge that rolls without slip on a level plane; it always touches.

        Parameters
        ----------
        wheel : Body or Spin
            A rigid body, or a spin on its carrier.
        radius : float
            m.
        centre, axis : array_like, shape (3,)
            As drawn, in earth axes, m and without unit; of a body, a spin has them.
        level : float
            Height z of the plane, m.

        Returns
        -------
        Joint
            It has no force that can be read.

        Raises
        ------
        ModelError
            The model is planar, the wheel is not rigid or lies flat, or it misses the plane by more than a thousandth
            of its radius.
        """
        return self._join(rolling(self, name, wheel, radius, centre, axis, level))

    def skate(
        self, name: str, body: Body, *, point: ArrayLike, direction: ArrayLike, switch: bool | None = None
    ) -> Joint:
        """A knife edge: a point of a body moves along a direction of the body only, seen from above.

        Parameters
        ----------
        point, direction : array_like, shape (2,) or (3,)
            As drawn, in earth axes, m and without unit; the height is free.
        switch : bool, optional
            With a switch of the same name, on or off at the start.

        Returns
        -------
        Joint
            It has no force that can be read.

        Raises
        ------
        ModelError
            The direction is vertical, or the body is not rigid.
        """
        return self._join(skate(self, name, body, point, direction, switch))
