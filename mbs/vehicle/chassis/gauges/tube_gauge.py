"""Strain gauges at a place of a tube, joined to the bridge that a measurement needs."""

import math
from collections.abc import Iterator
from typing import Annotated, Literal

import numpy as np
from pydantic import Discriminator, Tag

from mbs.common.errors import ModelError
from mbs.flexible.beam_axes import beam_axes
from mbs.flexible.frame import Frame
from mbs.flexible.recovery import StrainGauge
from mbs.vehicle.chassis.gauges.reading import STRESS, Reading
from mbs.vehicle.quantities import Fraction, Quantity
from mbs.vehicle.section import Section

Angle = Annotated[float, Quantity("deg", -360.0, 360.0)]
Way = Literal["top", "bottom", "left", "right", "front", "rear"]
Fibre = Annotated[
    Annotated[Way, Tag("way")] | Annotated[Angle, Tag("angle")],
    Discriminator(lambda value: "way" if isinstance(value, str) else "angle"),
]
WAYS = {
    "top": (0.0, 0.0, 1.0),
    "bottom": (0.0, 0.0, -1.0),
    "left": (0.0, 1.0, 0.0),
    "right": (0.0, -1.0, 0.0),
    "front": (1.0, 0.0, 0.0),
    "rear": (-1.0, 0.0, 0.0),
}
MIN_SINE = 0.3  # of the angle between a tube and the direction of a fibre


class TubeGauge(Section):
    """Strain gauges at a place of a tube."""

    tube: tuple[str, str]
    """First and last joint of the tube, as in the table of tubes or its mirror image."""
    place: Fraction
    """Place along it from the first joint."""
    bridge: Literal["half", "quarter", "axial", "torsion"] = "half"
    """half: a gauge on the fibre minus one on the opposite fibre, for bending; quarter: the gauge on the fibre alone;
    axial: around the whole tube, for tension; torsion: at 45 degrees around it, for twist."""
    fibre: Fibre = "top"
    """Fibre of the gauge: the one farthest up, down, to the left, right, front or rear of the car as drawn; or its
    angle in degrees from the highest fibre (of a tube within 18 degrees of upright: the foremost),
    right-handed about the tube from its first to its last joint."""

    def faults(self) -> Iterator[str]:
        """Fault of a bridge around the whole tube that names a fibre."""
        if self.bridge in ("axial", "torsion") and "fibre" in self.model_fields_set:
            yield f"{self.key('fibre')} is {self.fibre!r}; a bridge of kind '{self.bridge}' has no fibre, leave it out."

    def strain_gauge(
        self, name: str, ends: tuple[np.ndarray, np.ndarray], radius: float, elements: range
    ) -> StrainGauge:
        """Make the gauge on the elements of its tube.

        `ends`: first and last joint of the tube, m, shape (3,); `radius`: outer radius of the tube, m; `elements`: of
        the tube from the first joint. Raises `ModelError` if the fibre and the tube have the same direction.
        """
        position = self.place * len(elements)
        number = min(int(position), len(elements) - 1)
        y, z = self._direction(beam_axes(*ends)[1])
        return StrainGauge(name, elements[number], position - number, (radius * y, radius * z))

    def readings(self, gauge: StrainGauge, frame: Frame) -> Iterator[Reading]:
        """Readings of the gauge.

        `gauge`: result of `strain_gauge`; `frame`: frame with its tube.
        """
        name = gauge.name
        fibre = self.fibre if isinstance(self.fibre, str) else f"{self.fibre:g} deg"
        plus, minus = ("upper", "lower") if self.fibre == "top" else (fibre, "opposite")
        direction_text = "right-handed about the tube from its first to its last joint"
        rows = {
            "half": (
                ("bending_moment", "N.m", f"bending moment at gauge {name}, positive: {plus} fibre pulled"),
                (STRESS, "Pa", f"half-bridge {name}, {plus} minus {minus} fibre"),
            ),
            "quarter": ((STRESS, "Pa", f"normal stress of the {plus} fibre at gauge {name}, positive: pulled"),),
            "axial": (
                ("axial_force", "N", f"axial force at gauge {name}, positive: pulled"),
                (STRESS, "Pa", f"mean normal stress at gauge {name}, positive: pulled"),
            ),
            "torsion": (
                ("torsional_moment", "N.m", f"torsional moment at gauge {name}, positive: far end {direction_text}"),
                (STRESS, "Pa", f"shear stress by torsion at the surface at gauge {name}, sign of the moment"),
            ),
        }[self.bridge]
        matrices = {
            "half": (gauge.bending_moment, gauge.half_bridge),
            "quarter": (gauge.quarter_bridge,),
            "axial": (gauge.axial_force, gauge.axial_stress),
            "torsion": (gauge.torque, gauge.shear_stress),
        }[self.bridge]
        beam = frame.beams[gauge.element]
        ends = frame.names[beam.i], frame.names[beam.j]
        for (quantity, unit, text), matrix in zip(rows, matrices, strict=True):
            yield Reading(quantity, name, unit, text, matrix(frame).toarray()[0], ends, gauge.xi)

    def _direction(self, axes: np.ndarray) -> tuple[float, float]:
        """Unit vector (y, z) from the centre of the section to the fibre."""
        if not isinstance(self.fibre, str):
            angle = math.radians(self.fibre)
            return -math.sin(angle), math.cos(angle)
        _, y, z = axes @ np.array(WAYS[self.fibre])
        norm = math.hypot(y, z)
        if norm < MIN_SINE:
            raise ModelError(
                f"{self.key('fibre')} is '{self.fibre}', but the tube from {self.tube[0]} to {self.tube[1]} runs in "
                "that direction; name another fibre or its angle."
            )
        return y / norm, z / norm
