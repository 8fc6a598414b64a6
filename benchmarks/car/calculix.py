"""Beams and the prototype frame in CalculiX, an independent finite-element program: decks, runs, stored results.

CalculiX expands its quadratic beams B32R to solid elements with rigid sections at clamps and joints; this stiffens half
an element at each of them, an error of first order in the element length. So every case is run on three meshes, each
twice as fine as the previous one, and extrapolated (2 f(h/2) - f(h) of the two finest).
"""

import json
import re
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ali3.files import write_text
from benchmarks.car.statics import interface_forces
from benchmarks.shared.command import watched
from mbs.flexible.beam_axes import beam_axes
from mbs.flexible.frame import Beam, Frame
from mbs.flexible.section import Section
from mbs.vehicle import load
from mbs.vehicle.environment import GRAVITY

CAR = load("prototype")
FRAME = CAR.frame_section.tubular(CAR.folder)
INTERFACES = CAR.flexible_frame.interfaces
REFERENCE = str(CAR.flexible_frame.reference)
STEEL = FRAME.material
SECTIONS = FRAME.tube_sections

STORED = Path(__file__).parents[2] / "tests" / "data" / "calculix" / "frames.json"
TUBE_LENGTH = 1.5  # m, of the main tube of the frame
TIP_FORCE = 100.0  # N
TOWER_FORCE = 1000.0  # N, up at one front tower and down at the other
FREE = "*STEP\n*FREQUENCY\n{count}\n*END STEP\n"


def cantilever(elements: int) -> Frame:
    """The main tube of the frame along x, to be clamped at node 0."""
    x = np.zeros((elements + 1, 3))
    x[:, 0] = np.linspace(0.0, TUBE_LENGTH, elements + 1)
    beams = [Beam(i, i + 1, SECTIONS["M"], STEEL) for i in range(elements)]
    return Frame(x, beams, theory="timoshenko")


def deck(frame: Frame, steps: str) -> str:
    """Input deck of a frame of steel tubes: B32R beams with pipe sections and point masses; nodes count from 1."""
    nodes = list(frame.positions)
    lines = []
    for number, beam in enumerate(frame.beams, 1):
        start, end = frame.positions[beam.i], frame.positions[beam.j]
        nodes.append((start + end) / 2)
        outer, wall = _pipe(beam.section)
        left_axis = ",".join(f"{v:.9g}" for v in beam_axes(start, end)[1][1])
        lines += [f"*ELEMENT,TYPE=B32R,ELSET=E{number}", f"{number},{beam.i + 1},{len(nodes)},{beam.j + 1}"]
        lines += [f"*BEAM SECTION,ELSET=E{number},MATERIAL=STEEL,SECTION=PIPE", f"{outer:.9g},{wall:.9g}", left_axis]
    for node in np.flatnonzero(frame.masses):
        number = len(frame.beams) + int(node) + 1
        lines += [f"*ELEMENT,TYPE=MASS,ELSET=M{number}", f"{number},{node + 1}"]
        lines += [f"*MASS,ELSET=M{number}", f"{frame.masses[node]:.9g}"]
    node_lines = [f"{i},{x[0]:.9g},{x[1]:.9g},{x[2]:.9g}" for i, x in enumerate(nodes, 1)]
    material = ["*MATERIAL,NAME=STEEL", "*ELASTIC", f"{STEEL.E:g},{STEEL.nu:g}", "*DENSITY", f"{STEEL.rho:g}"]
    return "\n".join(["*NODE,NSET=ALL", *node_lines, *material, *lines, steps])


def run(text: str, suffix: str = ".dat") -> str:
    """Run a deck and return the text of a result file. Raises `FileNotFoundError` if ccx is not installed."""
    program = shutil.which("ccx")
    if program is None:
        raise FileNotFoundError("CalculiX (ccx) is not installed; on Debian: apt-get install calculix-ccx.")
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "deck.inp").write_text(text)
        process = subprocess.run([program, "deck"], cwd=folder, capture_output=True, text=True, check=False)
        if "Job finished" not in process.stdout:
            raise RuntimeError(f"CalculiX stopped: {process.stdout[-500:]}")
        return (Path(folder) / f"deck{suffix}").read_text()


def frequencies(results: str, count: int, skip: int = 0) -> list[float]:
    """Natural frequencies, Hz, from the eigenvalue table of a result file, after the first `skip`."""
    rows = re.findall(r"^ +\d+ +\S+ +\S+ +(\S+) +\S+ *$", results, re.MULTILINE)
    return [float(f) for f in rows[skip : skip + count]]


def displacement(results: str, node: int, axis: int) -> float:
    """Displacement of a node (numbered from 1) along an axis, m."""
    (row,) = re.findall(rf"^ +{node} +(\S+) +(\S+) +(\S+) *$", results, re.MULTILINE)
    return float(row[axis])


def tip_deflection(elements: int) -> float:
    """Deflection of the clamped tube under `TIP_FORCE`, m."""
    tip = elements + 1
    steps = f"*BOUNDARY\n1,1,6\n*STEP\n*STATIC\n*CLOAD\n{tip},3,{TIP_FORCE}\n*NODE PRINT,NSET=ALL\nU\n*END STEP\n"
    return displacement(run(deck(cantilever(elements), steps)), tip, 2)


def clamped_frequencies(elements: int) -> list[float]:
    """Three bending frequencies of the clamped tube, Hz (double eigenvalues)."""
    steps = "*BOUNDARY\n1,1,6\n" + FREE.format(count=6)
    return frequencies(run(deck(cantilever(elements), steps)), 6)[::2]


def torsional_stiffness(frame: Frame, drop: float) -> float:
    """Torsional stiffness, N m/deg, from the height difference `drop`, m, of the front towers under `TOWER_FORCE`."""
    towers = [frame.positions[frame.names.index(n)] for n in ("TFL", "TFR")]
    tower_distance = float(towers[0][1] - towers[1][1])
    return TOWER_FORCE * tower_distance / float(np.degrees(drop / tower_distance))


def frame_torsion(refinement: int) -> float:
    """Torsional stiffness of the prototype frame between its towers, the rear ones fixed, N m/deg."""
    frame, _ = FRAME.frame("timoshenko", refinement)
    left, right, rear_left, rear_right, middle = (frame.names.index(n) + 1 for n in ("TFL", "TFR", "TRL", "TRR", "S1c"))
    steps = (
        f"*BOUNDARY\n{rear_left},1,3\n{rear_right},1,3\n{middle},2,2\n*STEP\n*STATIC\n*CLOAD\n"
        f"{left},3,{TOWER_FORCE}\n{right},3,{-TOWER_FORCE}\n*NODE PRINT,NSET=ALL\nU\n*END STEP\n"
    )
    results = run(deck(frame, steps))
    return torsional_stiffness(frame, displacement(results, left, 2) - displacement(results, right, 2))


def frame_frequencies(refinement: int, carried_masses: bool, count: int) -> list[float]:
    """Elastic natural frequencies of the free prototype frame, Hz."""
    frame, _ = FRAME.frame("timoshenko", refinement, carried_masses)
    return frequencies(run(deck(frame, FREE.format(count=6 + count))), count, skip=6)


def gauge_moments(refinement: int) -> list[float]:
    """Vertical bending moments at the gauges of the prototype frame at rest on its suspension, N m.

    The reference node is clamped; weight and suspension forces leave no reaction there. CalculiX prints section forces
    at nodes; the gauges are at nodes if the refinement is even.
    """
    frame, tubes = FRAME.frame("timoshenko", refinement)
    forces = interface_forces(INTERFACES).reshape(-1, 3)
    clamped_node = frame.names.index(REFERENCE) + 1
    lines = ["*ELSET,ELSET=BEAMS", *(f"E{e + 1}," for e in range(len(frame.beams))), "*BOUNDARY", f"{clamped_node},1,6"]
    lines += ["*STEP", "*STATIC", "*DLOAD", f"BEAMS,GRAV,{GRAVITY},0.,0.,-1.", "*CLOAD"]
    for name, force in zip(INTERFACES, forces, strict=True):
        lines += [f"{frame.names.index(name) + 1},{axis + 1},{force[axis]:.9g}" for axis in range(3)]
    lines += [f"{i + 1},3,{-GRAVITY * frame.masses[i]:.9g}" for i in np.flatnonzero(frame.masses)]
    lines += ["*EL FILE,SECTION FORCES,OUTPUT=2D", "S", "*NODE PRINT,NSET=ALL", "U", "*END STEP"]
    moments = _bending_moments(run(deck(frame, "\n".join(lines) + "\n"), ".frd"))
    nodes = [frame.beams[g.element].i if g.xi == 0.0 else frame.beams[g.element].j for g in FRAME.strain_gauges(tubes)]
    return [moments[node + 1] for node in nodes]


def _bending_moments(frd: str) -> dict[int, float]:
    """Fifth section force by node, from a result file: the bending moment in the plane of the section's second
    axis, N m.
    """
    block, moments = "", {}
    for line in frd.splitlines():
        if line.startswith(" -4"):
            block = line.split()[1]
        elif line.startswith(" -1") and block == "STRESS":
            moments[int(line[3:13])] = float(line[61:73])
    return moments


def _pipe(section: Section) -> tuple[float, float]:
    """Outer radius and wall of a tube, m, from its radius and its area."""
    radius = section.fibres[0][1]
    return radius, radius - float(np.sqrt(radius**2 - section.area / np.pi))


TUBE = (16, 32, 64)  # elements of a tube, for each mesh
FRAMES = (2, 4, 8)  # refinements of the frame, for each mesh
CASES: dict[str, tuple[Callable[[int], Any], tuple[int, ...]]] = {
    "tube_tip_deflection_m": (tip_deflection, TUBE),
    "tube_clamped_hz": (clamped_frequencies, TUBE),
    "frame_torsional_stiffness_Nm_per_deg": (frame_torsion, FRAMES),
    "frame_loaded_free_hz": (lambda r: frame_frequencies(r, True, 5), FRAMES),
    "frame_bare_free_hz": (lambda r: frame_frequencies(r, False, 4), FRAMES),
    "frame_gauge_moments_Nm": (gauge_moments, FRAMES),
}


def store() -> None:
    """Run every case on three meshes, print and write the results."""
    results: dict[str, list[Any]] = {name: [] for name in CASES}
    for name, case, mesh in watched([(name, case, m) for name, (case, meshes) in CASES.items() for m in meshes]):
        results[name].append(case(mesh))
    version = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout.strip()
    stored: dict[str, Any] = {
        "origin": f"CalculiX, {version}; B32R beams with pipe sections; python -m benchmarks.frame calculix",
        "meshes": "three, each twice as fine; extrapolated = 2 f(h/2) - f(h) of the two finest",
    }
    for name, values in results.items():
        meshes = np.array(values)
        extrapolated = 2 * meshes[2] - meshes[1]
        stored[name] = {"meshes": meshes.tolist(), "extrapolated": np.round(extrapolated, 8).tolist()}
        print(f"{name}: {meshes.tolist()} -> {np.round(extrapolated, 6).tolist()}")
    STORED.parent.mkdir(parents=True, exist_ok=True)
    write_text(STORED, json.dumps(stored, indent=2) + "\n")
