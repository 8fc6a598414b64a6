"""A frame of tubes from tables."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from pydantic import Field

from mbs.vehicle.chassis.frames.frame_section import FrameSection, Structure
from mbs.vehicle.chassis.gauges.reading import in_order
from mbs.vehicle.chassis.gauges.tube_gauge import TubeGauge
from mbs.vehicle.chassis.tubular_frame import TubularFrame
from mbs.vehicle.names import Name
from mbs.vehicle.quantities import Length, MaterialDensity, PoissonsRatio, Thickness, YieldStrength, YoungsModulus
from mbs.vehicle.section import Section


class MaterialSection(Section):
    """Isotropic material."""

    E: YoungsModulus
    """Young's modulus."""
    nu: PoissonsRatio
    """Poisson's ratio."""
    rho: MaterialDensity
    """Density."""
    yield_strength: YieldStrength | None = None
    """Yield strength, a mark in pictures of stresses; no result depends on it."""


class TubeSection(Section):
    """Round tube."""

    diameter: Length
    """Outer diameter."""
    wall: Thickness
    """Thickness of the wall."""


class TubesFrame(FrameSection):
    """Frame of tubes between joints; tables beside the file give the left half and the centre plane.

    Names of joints end in L (mirrored to R) or c.
    """

    kind: Literal["tubes"]
    """Names this template."""
    joints: str
    """Table of the joints: joint, x, y, z."""
    tubes: str
    """Table of the tubes: from, to, section, elements."""
    masses: str | None = None
    """Table of the masses that joints carry: joint, mass; in a column image, no keeps a mass to its joint alone."""
    material: MaterialSection
    """Material of all tubes."""
    sections: dict[str, TubeSection]
    """Tubes by the names of the table."""
    gauges: dict[Name, TubeGauge] = Field(default_factory=dict)
    """Strain gauges by name."""

    def structure(self, folder: Path) -> Structure:
        """Read the tables.

        Parameters
        ----------
        folder : Path
            Of the car's file.

        Raises
        ------
        ModelError
            A table is missing or does not describe a frame.
        """
        tubular = TubularFrame(self, folder)
        frame, tubes = tubular.frame()
        gauges = tubular.strain_gauges(tubes)
        readings = [r for gauge in gauges for r in self.gauges[gauge.name].readings(gauge, frame)]
        return Structure(frame.finite_element_model(), in_order(readings), tubular.joint_places())

    def check(self, folder: Path) -> None:
        """Read the tables, and the places of the gauges.

        Parameters
        ----------
        folder : Path
            Of the car's file.

        Raises
        ------
        ModelError
            A table is missing or does not describe a frame, or a gauge is on no tube.
        """
        tubular = TubularFrame(self, folder)
        tubular.strain_gauges(tubular.frame()[1])
