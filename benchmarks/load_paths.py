"""Writes the loads of the frame of a car: ``python -m benchmarks.load_paths [--car CAR] [--output FILE]``.

The car with fidelity quasi_static drives the manoeuvres of the host and the guided kerb test; the forces at the
interfaces are snapshots.
Their principal combinations in the energy norm of the frame are what can deform it; the fidelity load_paths has their
deformations as modes. A car gets that fidelity by the key ``loads`` of its table ``chassis.frame``.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ali3.files import write_text
from ali3.running import run_command
from benchmarks.car import manoeuvres
from benchmarks.car.load_paths import GUIDED, port_forces, principal_loads
from benchmarks.shared.command import parser_of, watched
from mbs.vehicle import load

MANOEUVRES = ("launch_and_brake", "kerb_drop", "step_steer_given_throttle", "slalom", "drop", "full_lock", GUIDED)


def main(arguments: Sequence[str] | None = None) -> int:
    """Drive, decompose, write."""
    parser = parser_of("load_paths", __doc__, json=False)
    parser.add_argument("--car", default=manoeuvres.PROTOTYPE, help="name, folder or file; default: the prototype")
    parser.add_argument("--output", type=Path, help="default: the table that the car names, or loads.csv beside it")
    parser.add_argument("--manoeuvres", nargs="+", choices=MANOEUVRES, default=MANOEUVRES, help="default: all")
    options = parser.parse_args(arguments)
    car = load(options.car)
    frame = car.flexible_frame
    forces = np.hstack([port_forces(car, name) for name in watched(options.manoeuvres)])
    loads, sizes = principal_loads(frame, forces)
    driven = ", ".join(name.replace("_", " ") for name in options.manoeuvres)
    lines = [
        f"# Loads of the {car.name} car's frame, N, most deforming first: principal combinations of interface forces,",
        f"# body axes, in {driven} and their mirror images; rms values.",
        "# Source: this engine, rigid car with ports; made by python -m benchmarks.load_paths",
        ",".join(["interface", "axis", *(f"load_{k + 1}" for k in range(loads.shape[1]))]),
    ]
    for k, row in enumerate(loads):
        lines.append(",".join([frame.interfaces[k // 3], "xyz"[k % 3], *(f"{v:.7g}" for v in row)]))
    file = options.output or frame.folder / (frame.section.loads or "loads.csv")
    write_text(file, "\n".join(lines) + "\n")
    shown = np.array2string(sizes, precision=2)
    print(f"{2 * forces.shape[1]} snapshots, {loads.shape[1]} loads; sizes {shown}")
    if frame.section.loads is None:
        print(f'{file}: add loads = "{file.name}" to [chassis.frame] of the car')
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
