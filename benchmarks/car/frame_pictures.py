"""Pictures of frames: with their strain gauges; in the kerb test, deformed and coloured by stress."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.scene.recording import Recording
from benchmarks.shared.command import pyplot, save_chart
from mbs import Simulation, Trajectory, compile
from mbs.flexible.frame import Frame
from mbs.flexible.recovery import peak_tube_stress, section_force_field
from mbs.flexible.reduced_body import ReducedBody
from mbs.scenes import kerb_test, prototype_car
from mbs.vehicle import Car, Fidelity
from viewer.pictures import write_picture

Array = NDArray[np.float64]
SCALE = 150.0  # factor of the drawn deformation
END = 8.9  # s, after the rear wheels have landed
PERCENTILE = 99.5  # of the stresses: the colour scale ends there, since a few joints have much larger ones
SHOWN_KINDS = ("wheel", "spring", "damper")  # shapes that are drawn with the frame
MIN_LABEL_DISTANCE = (0.5, 0.1)  # m: names of gauges at smaller distances would overlap
VIEWS = ((0, 2, "z, m"), (0, 1, "y, m"))  # from the side, from above
UNDEFORMED = {"radius": 0.002, "color": "#bbbbbb"}  # style of the lines of the undeformed frame


@dataclass(frozen=True)
class Motion:
    """Deformation and stress of the frame over time."""

    t: Array
    """Times, s, shape (n,)."""
    positions: Array
    """Positions of the nodes with their deformation times `SCALE`, in chassis axes, m, shape (n, nodes, 3)."""
    stress: Array
    """Largest normal stress at the ends of each element, Pa, shape (n, elements, 2)."""


def kerb_picture(folder: Path) -> None:
    """Simulate the kerb test until both axles have landed, write the picture and print its path."""
    car = prototype_car.car()
    frame, _ = car.frame_section.tubular(car.folder).frame()
    body = car.flexible_frame.reduced(Fidelity.DYNAMIC)
    run: Trajectory = Simulation(compile(kerb_test.build(Fidelity.DYNAMIC))).run(END, kerb_test.STEP, progress=None)
    recording = run.recording()
    (part,) = (recording.scene or {})["flexible"]
    motion = motion_of(frame, body, run.t, np.column_stack([recording.columns[name] for name in part["amplitudes"]]))
    stress_at_rest, peak_stress = motion.stress[0].max() / 1e6, motion.stress.max() / 1e6
    print(f"largest normal stress {stress_at_rest:.1f} MPa at rest, {peak_stress:.1f} MPa in the test")
    folder.mkdir(parents=True, exist_ok=True)
    picture = folder / "frame_stress.png"
    draw(recording, motion, picture)
    print(f"written: {picture}")


def motion_of(frame: Frame, body: ReducedBody, t: Array, eta: Array, scale: float = SCALE) -> Motion:
    """Positions and stresses of the frame from modal amplitudes `eta` (n, modes)."""
    displacements = np.einsum("kij,nj->nki", body.node_translations, eta)
    forces = body.recovery(section_force_field(frame))
    stress = np.array([peak_tube_stress(frame, forces @ e) for e in eta])
    return Motion(t, frame.positions + scale * displacements, stress)


def frame_alone(recording: Recording, limit: float) -> Recording:
    """The recording with the frame, its undeformed lines, wheels, springs and dampers; `limit`: end of the colours,
    Pa.
    """
    scene: dict[str, Any] = dict(recording.scene or {})
    shapes = [shape for shape in scene["shapes"] if shape["kind"] in SHOWN_KINDS]
    flexible_parts = []
    for part in scene["flexible"]:
        nodes, carrier = part["nodes"], part["frame"]
        for i, j in part["beams"]:
            shapes.append({"kind": "tube", "points": [[carrier, nodes[i]], [carrier, nodes[j]]], **UNDEFORMED})
        stress = {key: value for key, value in part["stress"].items() if key not in ("limit", "limit_name")}
        flexible_parts.append(part | {"stress": stress | {"range": limit}})
    recording.scene = scene | {"shapes": shapes, "arrows": [], "flexible": flexible_parts}
    return recording


def draw(recording: Recording, motion: Motion, picture: Path) -> None:
    """Write the picture of the frame at the time of the largest stress."""
    frame_recording = frame_alone(recording, float(np.percentile(motion.stress, PERCENTILE)))
    options = {"stress": True, "deformation": SCALE}
    write_picture(
        picture, frame_recording, motion.t[int(motion.stress.max(axis=(1, 2)).argmax())], (1000, 600), None, options
    )


def draw_gauges(car: Car, file: str) -> None:
    """Draw the frame of a car with its joints and gauges, from the side and from above."""
    figure, axes = pyplot().subplots(2, 1, figsize=(8.6, 6.2), layout="constrained")
    for (i, j, label), a in zip(VIEWS, axes, strict=True):
        _frame_and_gauges(a, car, i, j)
        a.set(aspect="equal", xlabel="x, m", ylabel=label)
        a.margins(y=0.12)
    axes[0].legend(loc="upper right", frameon=False)
    save_chart(figure, Path(file))


def _frame_and_gauges(a: Any, car: Car, i: int, j: int) -> None:
    """Draw tubes, joints of the suspension and gauges in the plane of axes i and j; gauges at one position have one
    label.
    """
    tubular = car.frame_section.tubular(car.folder)
    frame, tubes = tubular.frame()
    x = frame.positions
    for beam in frame.beams:
        ends = x[[beam.i, beam.j]]
        a.plot(ends[:, i], ends[:, j], color="0.6", lw=1.2)
    joints = np.array([car.flexible_frame.place(name) for name in car.flexible_frame.interfaces])
    a.plot(joints[:, i], joints[:, j], "o", ms=4, color="tab:blue", label="joints of the suspension")
    names: dict[tuple[float, float], list[str]] = {}
    for gauge in tubular.strain_gauges(tubes):
        beam = frame.beams[gauge.element]
        position = (1.0 - gauge.xi) * x[beam.i] + gauge.xi * x[beam.j]
        names.setdefault((round(float(position[i]), 3), round(float(position[j]), 3)), []).append(gauge.name)
    if names:
        a.plot(*np.array(list(names)).T, "s", ms=8, color="tab:red", label="strain gauges")
    positions = list(names)
    for k, (position, gauges) in enumerate(names.items()):
        overlaps = any(
            abs(position[0] - x0) < MIN_LABEL_DISTANCE[0] and abs(position[1] - y0) < MIN_LABEL_DISTANCE[1]
            for x0, y0 in positions[:k]
        )
        style = {
            "xytext": (0, 9 if overlaps else -17),
            "textcoords": "offset points",
            "ha": "center",
            "color": "tab:red",
        }
        a.annotate(", ".join(gauges), position, **style)
