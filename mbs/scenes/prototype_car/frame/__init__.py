"""Tubular space frame of the prototype car: 58 joints, 129 tubes, 211 nodes, 1266 degrees of freedom.

The paper (section 4) publishes the size of the finite-element model and the number of modes, 65; the layout, the tubes,
the masses and the places of the gauges are assumed, the frame symmetric and every interface a hardpoint of the car.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from mbs.flexible import Beam, Frame, Material, RayleighDamping, StrainGauge, tube

STEEL = Material(E=2.10e11, nu=0.30, rho=7850.0)
SECTIONS = {"M": tube(0.040, 0.0020), "S": tube(0.030, 0.0015)}  # main and secondary tubes
REFERENCE = "S1c"  # floor centre, origin of the floating frame
INTERFACES = tuple(  # joints of the suspension; their translations are the 60 static modes
    f"{joint}{side}" for joint in ("LF", "LR", "UF", "UR", "RK", "TF", "AF", "AR", "TL", "TR") for side in "LR"
)
DYNAMIC_MODES = 5  # with the 60 static ones the paper's 65; the split is our reading
DAMPING = RayleighDamping.fitted(0.02, 15.0, 60.0)  # modal ratio assumed, fitted at two frequencies in Hz
# name to tube and place along it from its first joint: vertical bending of the sills ahead of and behind the cabin
GAUGES = {
    "SG1": ("LRL", "D1L", 0.25),
    "SG2": ("LRR", "D1R", 0.25),
    "SG3": ("B1L", "EML", 0.75),
    "SG4": ("B1R", "EMR", 0.75),
}


@dataclass(frozen=True)
class FrameTube:
    """A tube between two joints, with the numbers of its elements in the frame."""

    start: str
    end: str
    section: str
    elements: range


def prototype_frame(
    theory: str = "euler_bernoulli", refinement: int = 1, carried_masses: bool = True
) -> tuple[Frame, tuple[FrameTube, ...]]:
    """The frame and its tubes.

    Nodes are the joints by their names first, then the nodes inside the tubes ("LRL-D1L 1" and on); elements run from
    the first joint of each tube to the second.

    Parameters
    ----------
    theory : str
        "euler_bernoulli" or "timoshenko".
    refinement : int
        Multiplies the number of elements of every tube.
    carried_masses : bool
        Without them the frame is bare steel.
    """
    joints = _joints()
    names, positions = list(joints), list(joints.values())
    beams: list[Beam] = []
    tubes: list[FrameTube] = []
    for start, end, section, count in _tubes():
        divisions = count * refinement
        first = len(names)
        inner = range(1, divisions)
        names += [f"{start}-{end} {k}" for k in inner]
        positions += [joints[start] + (joints[end] - joints[start]) * (k / divisions) for k in inner]
        chain = [names.index(start), *range(first, first + len(inner)), names.index(end)]
        tubes.append(FrameTube(start, end, section, range(len(beams), len(beams) + divisions)))
        beams += [Beam(i, j, SECTIONS[section], STEEL) for i, j in pairwise(chain)]
    masses = _masses() if carried_masses else {}
    return Frame(np.array(positions), beams, masses, names, theory), tuple(tubes)


def strain_gauges(tubes: tuple[FrameTube, ...]) -> tuple[StrainGauge, ...]:
    """The four half-bridges on the elements of a frame of any refinement."""
    gauges = []
    for name, (start, end, place) in GAUGES.items():
        (found,) = (t for t in tubes if (t.start, t.end) == (start, end))
        along = place * len(found.elements)
        number = min(int(along), len(found.elements) - 1)
        gauges.append(StrainGauge(name, found.elements[number], along - number))
    return tuple(gauges)


def joint_places() -> dict[str, np.ndarray]:
    """Joints by name with their images, m."""
    return _joints()


def _mirrored(name: str) -> str:
    return name[:-1] + {"L": "R", "R": "L", "c": "c"}[name[-1]]


def _joints() -> dict[str, np.ndarray]:
    joints = {}
    for row in _rows("joints.csv"):
        place = np.array([float(row[axis]) for axis in "xyz"])
        joints[row["joint"]] = place
        joints.setdefault(_mirrored(row["joint"]), place * [1.0, -1.0, 1.0])
    return joints


def _tubes() -> list[tuple[str, str, str, int]]:
    tubes = []
    for row in _rows("tubes.csv"):
        start, end = row["from"], row["to"]
        tubes.append((start, end, row["section"], int(row["elements"])))
        image = (_mirrored(start), _mirrored(end))
        if set(image) != {start, end}:
            tubes.append((*image, row["section"], int(row["elements"])))
    return tubes


def _masses() -> dict[str | int, float]:
    masses: dict[str | int, float] = {}
    for row in _rows("masses.csv"):
        for joint in dict.fromkeys((row["joint"], _mirrored(row["joint"]))):
            masses[joint] = masses.get(joint, 0.0) + float(row["mass"])
    return masses


def _rows(name: str) -> list[dict[str, str]]:
    with (Path(__file__).parent / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))
