"""The frame in the kerb test, deformed and coloured by stress: motion and pictures."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.scene.recording import Recording
from mbs import Simulation, Trajectory, compile
from mbs.flexible.frame import Frame
from mbs.flexible.recovery import peak_tube_stress, section_force_field
from mbs.flexible.reduced_body import ReducedBody
from mbs.scenes import kerb_test
from mbs.vehicle import Fidelity
from viewer.pictures import write_picture
from viewer.video import write_mp4

Array = NDArray[np.float64]
SCALE = 150.0  # of the deformation
ANIMATED = (7.6, 8.9)  # s, from before the front wheels leave the kerb until after the rear wheels land
SPEED = 0.24  # of the animation beside real time
PERCENTILE = 99.5  # of the stresses, where the colours end: single joints would take all the range
SHOWN = ("wheel", "spring", "damper")  # beside the frame
AT_REST = {"radius": 0.002, "color": "#bbbbbb"}  # of the lines where the frame is not deformed


@dataclass(frozen=True)
class Motion:
    """What the frame does."""

    t: Array
    """Shape (n,): s."""
    places: Array
    """Shape (n, nodes, 3): deformed and scaled, in the axes of the chassis, m."""
    stress: Array
    """Shape (n, elements, 2): largest normal stress at the ends of each element, Pa."""


def kerb_run() -> Trajectory:
    """The kerb test until the end of the animation."""
    return Simulation(compile(kerb_test.build(Fidelity.DYNAMIC))).run(ANIMATED[1], kerb_test.STEP, progress=None)


def motion_of(frame: Frame, body: ReducedBody, t: Array, eta: Array, scale: float = SCALE) -> Motion:
    """Shapes and stresses from modal amplitudes of shape (n, modes)."""
    moved = np.einsum("kij,nj->nki", body.node_translations, eta)
    forces = body.recovery(section_force_field(frame))
    stress = np.array([peak_tube_stress(frame, forces @ e) for e in eta])
    return Motion(t, frame.positions + scale * moved, stress)


def frame_alone(recording: Recording, limit: float) -> Recording:
    """The recording with the frame, its place at rest, wheels, springs and dampers; colours end at a stress in Pa."""
    scene: dict[str, Any] = dict(recording.scene or {})
    shapes = [shape for shape in scene["shapes"] if shape["kind"] in SHOWN]
    coloured = []
    for part in scene["flexible"]:
        nodes, carrier = part["nodes"], part["frame"]
        for i, j in part["beams"]:
            shapes.append({"kind": "tube", "points": [[carrier, nodes[i]], [carrier, nodes[j]]], **AT_REST})
        stress = {key: value for key, value in part["stress"].items() if key not in ("limit", "limit_name")}
        coloured.append(part | {"stress": stress | {"range": limit}})
    recording.scene = scene | {"shapes": shapes, "arrows": [], "flexible": coloured}
    return recording


def draw(recording: Recording, motion: Motion, folder: Path) -> list[Path]:
    """Picture of the moment of the largest stress, and animation of the fall from the kerb."""
    shown = frame_alone(recording, float(np.percentile(motion.stress, PERCENTILE)))
    options = {"stress": True, "deformation": SCALE}
    picture, animation = folder / "frame_stress.png", folder / "frame_stress.webp"
    write_picture(picture, shown, motion.t[int(motion.stress.max(axis=(1, 2)).argmax())], (1000, 600), None, options)
    begin, end = ANIMATED
    write_mp4(animation, shown, fps=12, size=(700, 450), speed=SPEED, begin=begin, end=end, options=options)
    return [picture, animation]
