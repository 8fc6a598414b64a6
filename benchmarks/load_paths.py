"""Writes the loads of the prototype car's frame: ``python -m benchmarks.load_paths``.

The rigid car with ports (rung 1) drives the manoeuvres of the host and the guided kerb test; the forces at the twenty
interfaces are snapshots.
Their principal combinations in the energy norm of the frame are what can deform it; the second rung of the ladder has
their deformations as modes.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from benchmarks import car_manoeuvres, ladder_runs
from benchmarks.command import parser_of, watched
from mbs import Simulation
from mbs.input_signals import InputSignals
from mbs.scenes.prototype_car.chassis import LOAD_FILE, QUASI_STATIC, deformation_energy, settled_loads
from mbs.scenes.prototype_car.frame import INTERFACES

GUIDED = "kerb_test"
MANOEUVRES = ("launch_and_brake", "kerb_drop", "step_steer", "slalom", "drop", "full_lock", GUIDED)
H, EVERY = 0.005, 4
KEEP = 1e-4
"""Combinations with less than this part of the largest deformation, in the energy norm, are left out."""


def port_forces(name: str) -> NDArray[np.float64]:
    """Forces on the chassis at the interfaces in its axes through a manoeuvre, shape (60, samples), N."""
    manoeuvre = ladder_runs.manoeuvre_of(name) if name == GUIDED else car_manoeuvres.load(name)
    parameters, pose = car_manoeuvres.start_of(manoeuvre)
    system = ladder_runs.system_of(name, QUASI_STATIC)
    signals = InputSignals(car_manoeuvres.inputs_of(manoeuvre), system.meta["inputs"])
    car = Simulation(system, parameters=parameters, pose=pose)
    names = [row["name"] for row in system.meta["rows"]]
    rows = [[k for k, row in enumerate(names) if row == f"chassis.{node}"] for node in INTERFACES]
    scale = system.arrays["row_scale"]
    found = []
    inputs = list(signals.columns())
    for k in range(round(manoeuvre.stop_time / H)):
        values = signals.at(np.array([(k + 1) * H]), 1e-6 * H)[0]
        for column, value in zip(inputs, values, strict=True):
            car.instance.set_input(column, float(value))
        car.step(H)
        if k % EVERY == 0:
            s = car.sensors
            A = Rotation.from_quat([s[f"chassis.q{c}"] for c in "xyzw"]).as_matrix()
            lam = car.state.lam * scale
            found.append(np.concatenate([A.T @ lam[r] for r in rows]))
    return np.array(found).T


def mirrored(forces: NDArray[np.float64]) -> NDArray[np.float64]:
    """The same with left and right exchanged."""
    other = [INTERFACES.index(name[:-1] + {"L": "R", "R": "L"}[name[-1]]) for name in INTERFACES]
    parts = forces.reshape(len(INTERFACES), 3, -1)[other] * np.array([1.0, -1.0, 1.0])[:, None]
    return parts.reshape(forces.shape)


def main(arguments: Sequence[str] | None = None) -> int:
    """Drive, decompose, write."""
    parser_of("load_paths", __doc__, json=False).parse_args(arguments)
    driven = settled_loads(np.hstack([port_forces(name) for name in watched(MANOEUVRES)]))
    snapshots = np.hstack([driven, mirrored(driven)])
    energy = deformation_energy(snapshots)
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
        lines.append(",".join([INTERFACES[k // 3], "xyz"[k % 3], *(f"{v:.7g}" for v in row)]))
    LOAD_FILE.write_text("\n".join(lines) + "\n", encoding="utf-8")
    sizes = np.array2string(size[keep] / size[0], precision=2)
    print(f"{snapshots.shape[1]} snapshots, {loads.shape[1]} loads; sizes {sizes}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
