"""A frame of tubes from the tables of a car."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from mbs.flexible import Beam, Frame, Material, Section, StrainGauge, tube
from mbs.vehicle.chassis.frame_section import FrameSection


@dataclass(frozen=True)
class FrameTube:
    """A tube between two joints, with the numbers of its elements in the frame."""

    start: str
    end: str
    section: str
    elements: range


@dataclass(frozen=True)
class TubularFrame:
    """Tables of a frame.

    Attributes
    ----------
    section : FrameSection
        As in the car's file.
    folder : Path
        Of the tables.
    """

    section: FrameSection
    folder: Path

    @property
    def interfaces(self) -> tuple[str, ...]:
        """Joints of the suspension on both sides."""
        return tuple(f"{joint}{side}" for joint in self.section.interfaces for side in "LR")

    @property
    def material(self) -> Material:
        """Of all tubes."""
        return Material(self.section.material.E, self.section.material.nu, self.section.material.rho)

    @property
    def tube_sections(self) -> dict[str, Section]:
        """Tubes by the names of the table."""
        return {name: tube(s.diameter, s.wall) for name, s in self.section.sections.items()}

    def frame(
        self, theory: str = "euler_bernoulli", refinement: int = 1, carried_masses: bool = True
    ) -> tuple[Frame, tuple[FrameTube, ...]]:
        """The frame and its tubes.

        Nodes are the joints by their names first, then the nodes inside the tubes ("LRL-D1L 1" and on); elements run
        from the first joint of each tube to the second.

        Parameters
        ----------
        theory : str
            "euler_bernoulli" or "timoshenko".
        refinement : int
            Multiplies the number of elements of every tube.
        carried_masses : bool
            Without them the frame is bare tubes.
        """
        material, sections = self.material, self.tube_sections
        joints = self.joint_places()
        names, positions = list(joints), list(joints.values())
        beams: list[Beam] = []
        tubes: list[FrameTube] = []
        for start, end, section, count in self._tubes():
            divisions = count * refinement
            first = len(names)
            inner = range(1, divisions)
            names += [f"{start}-{end} {k}" for k in inner]
            positions += [joints[start] + (joints[end] - joints[start]) * (k / divisions) for k in inner]
            chain = [names.index(start), *range(first, first + len(inner)), names.index(end)]
            tubes.append(FrameTube(start, end, section, range(len(beams), len(beams) + divisions)))
            beams += [Beam(i, j, sections[section], material) for i, j in pairwise(chain)]
        masses = self._masses() if carried_masses else {}
        return Frame(np.array(positions), beams, masses, names, theory), tuple(tubes)

    def strain_gauges(self, tubes: tuple[FrameTube, ...]) -> tuple[StrainGauge, ...]:
        """The half-bridges on the elements of a frame of any refinement.

        Parameters
        ----------
        tubes : tuple of FrameTube
            From `frame`.
        """
        gauges = []
        for name, gauge in self.section.gauges.items():
            (found,) = (t for t in tubes if (t.start, t.end) == gauge.tube)
            along = gauge.place * len(found.elements)
            number = min(int(along), len(found.elements) - 1)
            gauges.append(StrainGauge(name, found.elements[number], along - number))
        return tuple(gauges)

    def joint_places(self) -> dict[str, np.ndarray]:
        """Joints by name with their images, m."""
        joints = {}
        for row in self._rows(self.section.joints):
            place = np.array([float(row[axis]) for axis in "xyz"])
            joints[row["joint"]] = place
            joints.setdefault(_mirrored(row["joint"]), place * [1.0, -1.0, 1.0])
        return joints

    def recorded_loads(self) -> np.ndarray:
        """Principal combinations of the interface forces in driving, shape (3 n_interfaces, n), N."""
        rows = self._rows(self.section.loads)
        return np.array([[float(v) for v in list(row.values())[2:]] for row in rows])

    def _tubes(self) -> list[tuple[str, str, str, int]]:
        tubes = []
        for row in self._rows(self.section.tubes):
            start, end = row["from"], row["to"]
            tubes.append((start, end, row["section"], int(row["elements"])))
            image = (_mirrored(start), _mirrored(end))
            if set(image) != {start, end}:
                tubes.append((*image, row["section"], int(row["elements"])))
        return tubes

    def _masses(self) -> dict[str | int, float]:
        masses: dict[str | int, float] = {}
        for row in self._rows(self.section.masses):
            for joint in dict.fromkeys((row["joint"], _mirrored(row["joint"]))):
                masses[joint] = masses.get(joint, 0.0) + float(row["mass"])
        return masses

    def _rows(self, name: str) -> list[dict[str, str]]:
        with (self.folder / name).open(encoding="utf-8", newline="") as file:
            return list(csv.DictReader(line for line in file if not line.startswith("#")))


def _mirrored(name: str) -> str:
    return name[:-1] + {"L": "R", "R": "L", "c": "c"}[name[-1]]
