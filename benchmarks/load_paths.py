"""Writes the loads of the prototype car's frame: ``python -m benchmarks.load_paths``.

The car with fidelity quasi_static drives the manoeuvres of the host and the guided kerb test; the forces at the twenty
interfaces are snapshots.
Their principal combinations in the energy norm of the frame are what can deform it; the fidelity load_paths has their
deformations as modes.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np

from ali3.files import write_text
from ali3.running import run_command
from benchmarks.car.load_paths import GUIDED, mirrored, port_forces
from benchmarks.shared.command import parser_of, watched
from mbs.scenes import prototype_car

MANOEUVRES = ("launch_and_brake", "kerb_drop", "step_steer", "slalom", "drop", "full_lock", GUIDED)
KEEP = 1e-4
"""Combinations with less than this part of the largest deformation, in the energy norm, are left out."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Drive, decompose, write."""
    parser_of("load_paths", __doc__, json=False).parse_args(arguments)
    frame = prototype_car.car().flexible_frame
    driven = frame.settled_loads(np.hstack([port_forces(name) for name in watched(MANOEUVRES)]))
    snapshots = np.hstack([driven, mirrored(driven)])
    energy = frame.deformation_energy(snapshots)
    values, vectors = np.linalg.eigh(energy)
    size = np.sqrt(np.maximum(values[::-1], 0.0))
    keep = size > KEEP * size[0]
    loads = (snapshots @ vectors[:, ::-1][:, keep]) / np.sqrt(snapshots.shape[1])
    large = np.abs(loads) > (1.0 - 1e-6) * np.abs(loads).max(axis=0)  # left and right tie: the first of them decides
    loads *= np.sign(loads[large.argmax(axis=0), np.arange(loads.shape[1])])
    lines = [
        "# Loads of the prototype car's frame, N, most deforming first: principal combinations of interface forces,",
        f"# body axes, in {', '.join(m.replace('_', ' ') for m in MANOEUVRES)} and their mirror images; rms values.",
        "# Source: this engine, rigid car with ports; made by python -m benchmarks.load_paths",
        ",".join(["interface", "axis", *(f"load_{k + 1}" for k in range(loads.shape[1]))]),
    ]
    for k, row in enumerate(loads):
        lines.append(",".join([frame.interfaces[k // 3], "xyz"[k % 3], *(f"{v:.7g}" for v in row)]))
    write_text(frame.folder / str(frame.section.loads), "\n".join(lines) + "\n")
    sizes = np.array2string(size[keep] / size[0], precision=2)
    print(f"{snapshots.shape[1]} snapshots, {loads.shape[1]} loads; sizes {sizes}")
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
