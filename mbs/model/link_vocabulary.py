"""Joints by name that many models need: thin wrappers around the functions of `mbs.model.joints`."""

from __future__ import annotations

from numpy.typing import ArrayLike

from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.coordinate import Coordinate
from mbs.model.ends import End, PointPair
from mbs.model.joints.distance import distance
from mbs.model.joints.drop_link import drop_link
from mbs.model.joints.joint import Joint
from mbs.model.joints.points import spherical
from mbs.model.joints.sliding import cylindrical, point_on_line


class LinkVocabulary(BodyVocabulary):
    """Joints of suspensions and of links; each method returns the joint, for sensors.

    Points and axes are given in earth axes in the reference configuration. Where the drawing does not close, `point`
    (or `axis`) may be a pair, one per body.
    """

    def _join(self, joint: Joint) -> Joint:
        self.unique("joint", joint.name)
        self.joints.append(joint)
        return joint

    def spherical(self, name: str, body_1: Body, body_2: Body, *, point: PointPair) -> Joint:
        """Spherical joint: the bodies share a point.

        Parameters
        ----------
        body_1, body_2 : Body
            Bodies, point masses, the ground, or nodes of flexible bodies.
        point : array_like, shape (dimension,), or pair of them
            Earth axes in the reference configuration, m; a pair is one point per body.
        """
        return self._join(spherical(self, name, body_1, body_2, point))

    def cylindrical(self, name: str, body_1: Body, body_2: Body, *, point: PointPair, axis: PointPair) -> Joint:
        """Cylindrical joint: the bodies share an axis, along which they slide and about which they turn.

        Parameters
        ----------
        body_1, body_2 : Body
            Bodies, the ground, or nodes of flexible bodies of a spatial model.
        point : array_like, shape (3,), or pair of them
            Point of body 1 on the axis of body 2, m.
        axis : array_like, shape (3,), or pair of them
            Of any length; a pair is one axis per body.

        Raises
        ------
        ModelError
            The model is planar, or the bodies are the same.
        """
        return self._join(cylindrical(self, name, body_1, body_2, point, axis))

    def point_on_line(
        self, name: str, end_1: tuple[Body, ArrayLike], end_2: tuple[Body, ArrayLike], *, axis: ArrayLike
    ) -> Joint:
        """A point of body 1 stays on a line fixed in body 2.

        Parameters
        ----------
        end_1 : (Body, array_like of shape (dimension,))
            Body 1 and its point, m.
        end_2 : (Body, array_like of shape (dimension,))
            Body 2 and a point of the line, m.
        axis : array_like, shape (dimension,)
            Direction of the line, fixed in body 2, of any length.

        Raises
        ------
        ModelError
            The bodies are the same, or body 2 is a point mass.
        """
        return self._join(point_on_line(self, name, end_1, end_2, axis))

    def distance(self, name: str, end_1: End, end_2: End, *, length: float | None = None) -> Joint:
        """Massless rod: the distance of two points is constant.

        Parameters
        ----------
        end_1, end_2 : (Body, array_like), Body or SlidingPoint
            A body and its point, m; a body alone for its centre of mass; or a point that a guide slides (one of the
            two at most).
        length : float, optional
            m; by default as drawn.

        Returns
        -------
        Joint
            For sensors: its force is the tension.

        Raises
        ------
        ModelError
            Both ends are on the same body, or the length is not positive.
        """
        return self._join(distance(self, name, end_1, end_2, length))

    def drop_link(
        self,
        name: str,
        carrier: Body,
        body: Body,
        *,
        pivot: ArrayLike,
        axis: ArrayLike,
        lever_end: ArrayLike,
        link_end: ArrayLike,
    ) -> Coordinate:
        """A lever that turns on a carrier and a rod from its end to a point of another body, both without mass.

        Two of them and `anti_roll_bar` are an anti-roll bar with its links. Against two bodies with joints it costs one
        coordinate and one equation. The tension of the rod is a joint force.

        Parameters
        ----------
        carrier, body : Body
            What the lever turns on, and where the rod ends; in space, not point masses.
        pivot, axis : array_like, shape (3,)
            A point of the lever's axis, m, and its direction, fixed in the carrier; earth axes as drawn.
        lever_end, link_end : array_like, shape (3,)
            Ends of the rod on the lever and on the body, earth axes as drawn, m.

        Returns
        -------
        Coordinate
            Angle of the lever about the axis, rad, 0 as drawn and not wrapped.

        Raises
        ------
        ModelError
            The bodies are the same, the lever lies along its axis, or the rod pulls along the lever or across its plane
            and could not turn it.
        """
        coordinate, joint = drop_link(self, name, carrier, body, pivot, axis, lever_end, link_end)
        self._join(joint)
        return coordinate
