"""A frame of tubes: its section of a car file, and the finite elements of its tables."""

import pickle
from collections.abc import Container
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import Field

from mbs.common.errors import ModelError
from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.frame import Beam, Frame
from mbs.flexible.material import Material
from mbs.flexible.recovery import StrainGauge
from mbs.flexible.section import Section as CrossSection
from mbs.flexible.section import tube
from mbs.vehicle.chassis.frames.frame_section import FrameSection, Structure
from mbs.vehicle.chassis.gauges.reading import sort_readings
from mbs.vehicle.chassis.gauges.tube_gauge import TubeGauge
from mbs.vehicle.names import Name
from mbs.vehicle.quantities import Length, MaterialDensity, PoissonsRatio, Thickness, YieldStrength, YoungsModulus
from mbs.vehicle.section import Section
from mbs.vehicle.table import Row, read_table

IMAGE = {"L": "R", "R": "L", "c": "c"}
MAX_COORDINATE, MAX_ELEMENTS, MAX_MASS = 9.0, 50, 2000.0  # m, of a tube, kg


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
    """Table of the masses that joints carry: joint, mass; in a column image, no leaves out the image of a mass that
    balances a payload: like one it rides on the frame at its place."""
    material: MaterialSection
    """Material of all tubes."""
    sections: dict[str, TubeSection]
    """Tubes by the names of the table."""
    gauges: dict[Name, TubeGauge] = Field(default_factory=dict)
    """Strain gauges by name."""

    def tubular(self, folder: Path) -> "TubularFrame":
        """Tables of the frame. `folder`: folder of the car file."""
        return TubularFrame(self, folder)

    def structure(self, folder: Path) -> Structure:
        """Read the tables."""
        tubular = self.tubular(folder)
        frame, tubes = tubular.frame()
        gauges = tubular.strain_gauges(tubes)
        readings = sort_readings(r for gauge in gauges for r in self.gauges[gauge.name].readings(gauge, frame))
        return Structure(_assemble(pickle.dumps(frame)), readings, tubular.joint_places(), tubular.riding())

    def check(self, folder: Path) -> None:
        """Read the tables and the places of the gauges, each of which must be on a tube."""
        tubular = self.tubular(folder)
        tubular.strain_gauges(tubular.frame()[1])


@dataclass(frozen=True)
class FrameTube:
    """A tube between two joints, with the numbers of its elements in the frame."""

    start: str
    end: str
    section: str
    elements: range


@dataclass(frozen=True)
class TubularFrame:
    """A frame of tubes from its tables."""

    section: TubesFrame
    """Section of the car file."""
    folder: Path
    """Folder of the tables."""

    @property
    def material(self) -> Material:
        """Material of all tubes."""
        material = self.section.material
        return Material(material.E, material.nu, material.rho, material.yield_strength)

    @property
    def tube_sections(self) -> dict[str, CrossSection]:
        """Cross-sections of tubes by name."""
        sections = {}
        for name, s in self.section.sections.items():
            if 2.0 * s.wall > s.diameter:
                raise ModelError(
                    f"{s.key('wall')} is {s.wall:g} m; a tube of {s.diameter:g} m has at most half of that."
                )
            sections[name] = tube(s.diameter, s.wall)
        return sections

    def frame(
        self, theory: str = "euler_bernoulli", refinement: int = 1, carried_masses: bool = True
    ) -> tuple[Frame, tuple[FrameTube, ...]]:
        """Make the frame and its tubes.

        Nodes are the joints, then the nodes within the tubes ("LRL-D1L 1" and on); elements run from the first joint of
        each tube to the second.

        `theory`: "euler_bernoulli" or "timoshenko"; `refinement`: factor on the number of elements of every tube;
        `carried_masses`: whether the masses of joints are included, except for `riding`. Raises `ModelError` if a
        table is missing or does not describe a frame.
        """
        material, sections = self.material, self.tube_sections
        joints = self.joint_places()
        names, positions = list(joints), list(joints.values())
        beams: list[Beam] = []
        tubes: list[FrameTube] = []
        for start, end, section, count in self._tubes(joints):
            divisions = count * refinement
            first = len(names)
            inner = range(1, divisions)
            names += [f"{start}-{end} {k}" for k in inner]
            positions += [joints[start] + (joints[end] - joints[start]) * (k / divisions) for k in inner]
            chain = [names.index(start), *range(first, first + len(inner)), names.index(end)]
            tubes.append(FrameTube(start, end, section, range(len(beams), len(beams) + divisions)))
            beams += [Beam(i, j, sections[section], material) for i, j in pairwise(chain)]
        masses: dict[str | int, float] = {}
        if carried_masses:
            masses.update(self._masses(joints, "yes").items())
        return Frame(np.array(positions), beams, masses, names, theory), tuple(tubes)

    def strain_gauges(self, tubes: tuple[FrameTube, ...]) -> tuple[StrainGauge, ...]:
        """Make the gauges on the elements of a frame of any refinement.

        `tubes`: result of `frame`. Raises `ModelError` if a gauge is on no tube, or its fibre is named by a direction
        in which the tube runs.
        """
        joints, gauges = self.joint_places(), []
        for name, gauge in self.section.gauges.items():
            frame_tube = _gauge_tube(gauge, tubes)
            ends = joints[frame_tube.start], joints[frame_tube.end]
            radius = 0.5 * self.section.sections[frame_tube.section].diameter
            gauges.append(gauge.strain_gauge(name, ends, radius, frame_tube.elements))
        return tuple(gauges)

    def joint_places(self) -> dict[str, np.ndarray]:
        """Read the positions of the joints and of their images by name, m."""
        joints: dict[str, np.ndarray] = {}
        names: set[str] = set()
        for row in read_table(self.folder, self.section.joints, self.section.key("joints"), ("joint", "x", "y", "z")):
            name = row["joint"]
            position = np.array([row.number(axis, -MAX_COORDINATE, MAX_COORDINATE, "m") for axis in "xyz"])
            _check_joint(row, name, float(position[1]), names)
            joints[name] = position
            joints.setdefault(image_name(name), position * [1.0, -1.0, 1.0])
        return joints

    def _tubes(self, joints: dict[str, np.ndarray]) -> list[tuple[str, str, str, int]]:
        """Read first joint, second joint, cross-section and number of elements of the tubes and of their images."""
        tubes: list[tuple[str, str, str, int]] = []
        key, sections = self.section.key("tubes"), self.section.sections
        ends: set[frozenset[str]] = set()
        for row in read_table(self.folder, self.section.tubes, key, ("from", "to", "section", "elements")):
            start, end = row["from"], row["to"]
            for name in (start, end):
                _check_name(row, name, joints, "joint", self.section.key("joints"))
            _check_name(row, row["section"], sections, "section", self.section.key("sections"))
            image = (image_name(start), image_name(end))
            pairs = [(start, end)] if set(image) == {start, end} else [(start, end), image]
            if start == end or not ends.isdisjoint(frozenset(pair) for pair in pairs):
                why = "has one joint at both ends" if start == end else "occurs twice: images are added automatically"
                raise ModelError(f"{row.where}: the tube from {start} to {end} {why}.")
            ends.update(frozenset(pair) for pair in pairs)
            tubes += [(*pair, row["section"], row.count("elements", MAX_ELEMENTS)) for pair in pairs]
        return tubes

    def riding(self) -> dict[str, float]:
        """Read the masses without an image by joint, kg. Raises `ModelError` if their table is missing or not valid."""
        return self._masses(self.joint_places(), "no")

    def _masses(self, joints: dict[str, np.ndarray], image: str) -> dict[str, float]:
        """Read the masses by joint, kg, of the lines with the given value of the column `image`, "yes" or "no"."""
        masses: dict[str, float] = {}
        if self.section.masses is None:
            return masses
        for row in read_table(self.folder, self.section.masses, self.section.key("masses"), ("joint", "mass")):
            _check_name(row, row["joint"], joints, "joint", self.section.key("joints"))
            for joint in _loaded_joints(row, image):
                masses[joint] = masses.get(joint, 0.0) + row.number("mass", 0.0, MAX_MASS, "kg")
        return masses


def image_name(name: str) -> str:
    """Name of the image of a joint, whose last letter is its side."""
    return name[:-1] + IMAGE[name[-1]]


def _loaded_joints(row: Row, image_filter: str) -> tuple[str, ...]:
    """Joints with the mass of a line: the named one and its image; none if the column `image` is not `image_filter`."""
    joint, image = row["joint"], row.cells.get("image") or "yes"
    if image not in ("yes", "no"):
        raise ModelError(f"{row.where}: image is {image!r}; it must be yes or no, or left empty for yes.")
    if image != image_filter:
        return ()
    return (joint,) if image == "no" else tuple(dict.fromkeys((joint, image_name(joint))))


def _gauge_tube(gauge: TubeGauge, tubes: tuple[FrameTube, ...]) -> FrameTube:
    """Tube of a gauge. Raises `ModelError` if there is none between its joints."""
    tubes_by_ends = {(t.start, t.end): t for t in tubes}
    if gauge.tube in tubes_by_ends:
        return tubes_by_ends[gauge.tube]
    start, end = gauge.tube
    if (end, start) in tubes_by_ends:
        hint = f"the tube runs from {end} to {start}, and place counts from {end}"
    else:
        neighbours = sorted({b if a == start else a for a, b in tubes_by_ends if start in (a, b)})
        hint = f"tubes lead from {start} to {', '.join(neighbours)}" if neighbours else f"no tube ends at {start}"
    raise ModelError(f"{gauge.key('tube')} is {list(gauge.tube)}, which is not a tube of the frame: {hint}.")


def _check_joint(row: Row, name: str, y: float, names: set[str]) -> None:
    """Check the name of a joint against its side and the names before, and add it to these. `y`: m."""
    if name[-1:] not in ("L", "c"):
        raise ModelError(f"{row.where}: joint is {name!r}; its name must end in L (left) or c (centre plane).")
    if name in names:
        raise ModelError(f"{row.where}: joint {name} occurs twice.")
    names.add(name)
    if (name[-1] == "L") != (y > 0.0) or (name[-1] == "c" and y != 0.0):
        rule = "positive on the left" if name[-1] == "L" else "0 on the centre plane"
        raise ModelError(f"{row.where}: joint {name} has y = {y:g} m; y must be {rule}.")


def _check_name(row: Row, name: str, names: Container[str], kind: str, key: str) -> None:
    """Raise `ModelError` if a name is not in another table. `key`: key path of that table."""
    if name not in names:
        raise ModelError(f"{row.where}: {kind} {name!r} is not in {key}.")


@lru_cache(maxsize=4)
def _assemble(frame: bytes) -> FiniteElementModel:
    """Finite-element model of a pickled `Frame`, cached: cars that differ in other numbers share it."""
    model: FiniteElementModel = pickle.loads(frame).finite_element_model()
    return model
