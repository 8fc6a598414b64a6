"""The frame in the kerb test, deformed and coloured by stress: ``python -m benchmarks.stress_picture [--out DIR]``.

Runs the scene kerb_test and draws the moment of the largest stress as PNG and the fall from the kerb as animated WebP:
the largest normal stress round each tube, with the deformation scaled up. Pictures are made by a Chromium, films with
the extra ``pictures``: ``pip install "ali3[pictures]"``.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ali3.running import run_command
from benchmarks.car.stress_picture import draw, kerb_run, motion_of
from benchmarks.shared.command import parser_of
from mbs.scenes import prototype_car
from mbs.vehicle import Fidelity


def main(arguments: Sequence[str] | None = None) -> int:
    """Run, draw, say where."""
    parser = parser_of("stress_picture", __doc__, json=False)
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR", help="folder for results; default: out")
    options = parser.parse_args(arguments)
    car = prototype_car.car()
    frame, _ = car.frame_section.tubular(car.folder).frame()
    body = car.flexible_frame.reduced(Fidelity.DYNAMIC)
    run = kerb_run()
    recording = run.recording()
    (part,) = (recording.scene or {})["flexible"]
    motion = motion_of(frame, body, run.t, np.column_stack([recording.columns[name] for name in part["amplitudes"]]))
    rest, peak = motion.stress[0].max() / 1e6, motion.stress.max() / 1e6
    print(f"largest normal stress {rest:.1f} MPa at rest, {peak:.1f} MPa in the test")
    options.out.mkdir(parents=True, exist_ok=True)
    files = draw(recording, motion, options.out)
    print(f"written: {', '.join(map(str, files))}")
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
