"""Section of a car file for a tubular frame, with its tables."""

from typing import Literal

from pydantic import Field

from mbs.vehicle.chassis.frames.frame_section import FrameSection
from mbs.vehicle.chassis.gauges.tube_gauge import TubeGauge
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


class TubeTables(FrameSection):
    """Tables beside the file, and what they name."""

    kind: Literal["tubes"]
    """Names this template."""
    joints: str
    """Table of the joints: joint, x, y, z."""
    tubes: str
    """Table of the tubes: from, to, section, elements."""
    masses: str | None = None
    """Table of the masses that joints carry: joint, mass; in a column image, no leaves out the image of a mass that
    balances a payload: like one it rides on the frame at its place."""
    material: MaterialSection
    """Material of all tubes."""
    sections: dict[str, TubeSection]
    """Tubes by the names of the table."""
    gauges: dict[Name, TubeGauge] = Field(default_factory=dict)
    """Strain gauges by name."""
