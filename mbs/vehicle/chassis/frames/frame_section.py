"""Base class of the sections of flexible frames in a car file."""

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Discriminator, Field, Tag

from mbs.flexible.fe_model import FiniteElementModel
from mbs.vehicle.chassis.gauges.reading import Reading
from mbs.vehicle.quantities import Fraction, Frequency
from mbs.vehicle.section import Section

Count = Annotated[int, Field(strict=True, ge=0, le=1000)]
Reference = Annotated[
    Annotated[str, Tag("joint")] | Annotated[tuple[str, str, str], Tag("nodes")],
    Discriminator(lambda value: "joint" if isinstance(value, str) else "nodes"),
]


@dataclass(frozen=True)
class Structure:
    """A frame as finite elements."""

    model: FiniteElementModel
    """In the axes of the drawing."""
    readings: tuple[Reading, ...]
    """What its gauges report, in the order of the outputs."""
    joints: Mapping[str, np.ndarray]
    """Each of shape (3,): nodes where suspension, drive and payloads may be fixed, m."""
    riding: Mapping[str, float] = field(default_factory=dict)
    """Masses that balance payloads, by joint, kg; added to the frame as these are, and not part of `model`."""


class DampingSection(Section):
    """Rayleigh damping. The ratio holds for the frame held at its reference; modes of the free frame have more."""

    ratio: Fraction
    """Modal damping ratio at two frequencies."""
    frequencies: tuple[Frequency, Frequency]
    """The two frequencies."""


class FrameSection(Section):
    """Numbers common to flexible frames; the suspension is attached to the joints of a frame at the hard points."""

    damping: DampingSection
    """Damping of the frame."""
    dynamic_modes: Count = 5
    """Number of dynamic modes of fidelity 3."""
    loads: str | None = None
    """Table of the load paths: interface, axis, load_1, load_2, ...; without it there is no fidelity 2."""
    or_rigid: bool = False
    """Whether a frame that does not fit the hard points or the mass of the car is replaced by a rigid one, with a
    warning; otherwise it is refused."""
    reference: Reference | None = None
    """Joint at chassis.reference that carries the floating frame, by default the one that is there; of a model without
    rotations three nodes that span a triangle, the first of them there."""
    drive_mounts: tuple[str, str, str] | None = None
    """Left joints that take the reaction of the drive: front, rear, top; by default the two pivots of an arm of the
    driven axle and its highest joint."""
    ground_mounts: tuple[str, ...] | None = None
    """Left joints through which forces of the ground on the chassis enter the frame; by default the joints of the drive
    and the first one of the axle that is not driven."""

    @abstractmethod
    def structure(self, folder: Path) -> Structure:
        """Read the frame. Raises `ModelError` if a file is missing or does not describe a frame."""

    @abstractmethod
    def check(self, folder: Path) -> None:
        """Check what needs no large files.

        Raises `ModelError` if a file is missing, or a table is not right.
        """
