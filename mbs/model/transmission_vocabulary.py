"""Transmissions by name: gears, racks and screws."""

from __future__ import annotations

from numpy.typing import ArrayLike

from mbs.model.body import Body
from mbs.model.coordinate import Coordinate
from mbs.model.joints.coupled_slides import Slide, coupled_slides
from mbs.model.joints.gear import gear
from mbs.model.joints.joint import Joint
from mbs.model.joints.rack import rack
from mbs.model.joints.screw import Screw, screw
from mbs.model.mechanism import Mechanism


class TransmissionVocabulary(Mechanism):
    """The transmissions of a model; each method returns the joint, for sensors."""

    def gear(self: Mechanism, name: str, wheel_1: Coordinate, wheel_2: Coordinate, *, ratio: float) -> Joint:
        """Two wheels that turn in a constant ratio.

        Parameters
        ----------
        wheel_1, wheel_2 : Coordinate
            Relative angles of the wheels against what carries them, or spins.
        ratio : float
            Turns of the first wheel for one of the second, each against its carrier; negative where they turn opposite
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
        return self._join(gear(self, name, wheel_1, wheel_2, ratio))

    def rack(
        self: Mechanism,
        name: str,
        pinion: Coordinate,
        body: Body,
        *,
        carrier: Body,
        axis: ArrayLike,
        radius: float,
        point: ArrayLike | None = None,
    ) -> Joint:
        """A rack that slides on a carrier by the radius of a pinion per radian; it guides nothing (see `prismatic`).

        Parameters
        ----------
        pinion : Coordinate
            Relative angle of the pinion against the carrier, or a spin on it.
        axis : array_like, shape (dimension,)
            Direction of the slide, fixed in the carrier, earth axes as drawn.
        radius : float
            m per rad; negative where the rack goes against `axis` when the pinion turns positively.
        point : array_like, shape (dimension,), optional
            Of the rack, as drawn, m; by default its centre of mass.

        Returns
        -------
        Joint
            For sensors: its force on the rack along the axis.

        Raises
        ------
        ModelError
            The radius is zero, the carrier is a point mass, or the rack is the ground or the carrier.
        """
        return self._join(rack(self, name, pinion, body, carrier, axis, radius, point))

    def coupled_slides(
        self,
        name: str,
        body_1: Body,
        body_2: Body,
        *,
        carrier_1: Body,
        carrier_2: Body,
        axis_1: ArrayLike,
        axis_2: ArrayLike,
        ratio: float,
    ) -> Joint:
        """Two bodies that slide on their carriers in a constant ratio, as the fingers of a gripper; guides nothing.

        Parameters
        ----------
        axis_1, axis_2 : array_like, shape (dimension,)
            Directions of the slides, fixed in their carriers, earth axes as drawn.
        ratio : float
            Metres of the first for one metre of the second, m/m.

        Returns
        -------
        Joint
            For sensors: its force on the first body along its axis.

        Raises
        ------
        ModelError
            The ratio is zero, both bodies are one, a carrier is a point mass, or a body is the ground or its carrier.
        """
        slides = Slide(body_1, carrier_1, axis_1), Slide(body_2, carrier_2, axis_2)
        return self._join(coupled_slides(self, name, *slides, ratio))

    def screw(self, name: str, body_1: Body, body_2: Body, *, point: ArrayLike, axis: ArrayLike, pitch: float) -> Screw:
        """Screw joint: a shared axis along which body 1 moves in proportion to its turn against body 2.

        Parameters
        ----------
        body_1, body_2 : Body
            Bodies or the ground of a spatial model.
        point : array_like, shape (3,)
            On the axis, m.
        axis : array_like, shape (3,)
            Of any length.
        pitch : float
            Way along the axis per turn, m; positive for a right-hand thread.

        Returns
        -------
        Screw
            Its `angle` is that turn, rad, a coordinate for sensors and torques.

        Raises
        ------
        ModelError
            The model is planar, the pitch is zero, or the bodies are the same.
        """
        joint, angle = screw(self, name, body_1, body_2, point, axis, pitch)
        self._join(joint)
        self._join(angle)
        return joint
