"""Tables of a flexible frame of tubes."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from mbs.vehicle.quantities import Fraction, Frequency, Length, MaterialDensity, PoissonsRatio, Thickness, YoungsModulus
from mbs.vehicle.section import Section

Count = Annotated[int, Field(strict=True, ge=0, le=1000)]


class MaterialSection(Section):
    """Isotropic material."""

    E: YoungsModulus
    """Young's modulus."""
    nu: PoissonsRatio
    """Poisson's ratio."""
    rho: MaterialDensity
    """Density."""


class TubeSection(Section):
    """Round tube."""

    diameter: Length
    """Outer diameter."""
    wall: Thickness
    """Thickness of the wall."""


class DampingSection(Section):
    """Rayleigh damping."""

    ratio: Fraction
    """Modal damping ratio at two frequencies."""
    frequencies: tuple[Frequency, Frequency]
    """The two frequencies."""


class GaugeSection(Section):
    """Half-bridge of strain gauges for vertical bending."""

    tube: tuple[str, str]
    """First and last joint of the tube, as in the table of tubes."""
    place: Fraction
    """Place along it from the first joint."""


class FrameSection(Section):
    """Frame of tubes between joints; tables beside the file give the left half and the centre plane.

    Names of joints end in L (mirrored to R) or c.
    """

    joints: str
    """Table of the joints: joint, x, y, z."""
    tubes: str
    """Table of the tubes: from, to, section, elements."""
    masses: str
    """Table of the masses that joints carry: joint, mass."""
    loads: str
    """Table of the load paths: interface, axis, load_1 and on."""
    material: MaterialSection
    """Material of all tubes."""
    sections: dict[str, TubeSection]
    """Tubes by the names of the table."""
    reference: str
    """Joint that carries the floating frame."""
    interfaces: tuple[str, ...]
    """Joints of the suspension without their side; their translations are the static modes."""
    rigid_pairs: tuple[tuple[str, str], ...]
    """Joints without their side whose distance a part of the suspension holds, as the pivots of a wishbone."""
    drive_mounts: tuple[str, str, str]
    """Joints without their side that take the reaction of the drive: front, rear, top."""
    ground_mounts: tuple[str, ...]
    """Joints without their side through which forces of the ground on the chassis enter the frame."""
    dynamic_modes: Count
    """Number of dynamic modes."""
    damping: DampingSection
    """Damping of the frame."""
    gauges: dict[str, GaugeSection] = Field(default_factory=dict)
    """Strain gauges by name."""
