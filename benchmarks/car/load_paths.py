"""Forces at the interfaces of a car's frame in its manoeuvres, and their principal combinations.

The car with fidelity quasi_static drives the manoeuvres of the host and the guided kerb test. Snapshots of the forces
at the interfaces have principal combinations in the energy norm of the frame, whose deformations are the modes of the
fidelity load_paths.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ali3.files import write_text
from benchmarks.car import manoeuvres
from benchmarks.shared.command import watched
from hosts.driving.manoeuvre import Manoeuvre
from mbs import Simulation, compile
from mbs.scenes import kerb_test
from mbs.settings.input_signals import InputSignals
from mbs.vehicle import Car, Fidelity
from mbs.vehicle.chassis.flexible_frame import FlexibleFrame

GUIDED = "kerb_test"
MANOEUVRES = ("launch_and_brake", "kerb_drop", "step_steer_given_throttle", "slalom", "drop", "full_lock", GUIDED)
H = 0.005  # step, s
EVERY = 4  # steps between snapshots
KEEP = 1e-4
"""Share of the largest deformation, in the energy norm, below which combinations are left out."""


def port_forces(car: Car, name: str) -> NDArray[np.float64]:
    """Forces on the chassis at the interfaces in a manoeuvre, chassis axes, N, shape (3 n_interfaces, samples)."""
    if name == GUIDED:
        manoeuvre = Manoeuvre(name, np.zeros(0), {}, kerb_test.DURATION)
        model = kerb_test.build(Fidelity.QUASI_STATIC, car)
    else:
        manoeuvre, model = manoeuvres.load(name, car.name), car.model(fidelity=Fidelity.QUASI_STATIC)
    system = compile(model)
    parameters, pose = manoeuvres.start_of(manoeuvre, system)
    signals = InputSignals(manoeuvres.inputs_of(manoeuvre, system), system.meta["inputs"])
    simulation = Simulation(system, parameters=parameters, pose=pose)
    names = [row["name"] for row in system.meta["rows"]]
    interfaces = car.flexible_frame.interfaces
    rows = [[k for k, row in enumerate(names) if row == f"chassis.{node}"] for node in interfaces]
    scale = system.arrays["row_scale"]
    snapshots = []
    inputs = list(signals.columns())
    for k in range(round(manoeuvre.stop_time / H)):
        values = signals.at(np.array([(k + 1) * H]), 1e-6 * H)[0]
        for column, value in zip(inputs, values, strict=True):
            simulation.instance.set_input(column, float(value))
        simulation.step(H)
        if k % EVERY == 0:
            s = simulation.sensors
            A = Rotation.from_quat([s[f"chassis.q{c}"] for c in "xyzw"]).as_matrix()
            lam = simulation.state.lam * scale
            snapshots.append(np.concatenate([A.T @ lam[r] for r in rows]))
    return np.array(snapshots).T


def mirrored(frame: FlexibleFrame, forces: NDArray[np.float64]) -> NDArray[np.float64]:
    """Forces with left and right exchanged."""
    positions = list(frame.joints.interfaces.values())
    mirror_indices = [positions.index((x, -y, z)) for x, y, z in positions]
    mirrored_forces = forces.reshape(len(positions), 3, -1)[mirror_indices] * np.array([1.0, -1.0, 1.0])[:, None]
    return mirrored_forces.reshape(forces.shape)


def principal_loads(
    frame: FlexibleFrame, forces: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Principal combinations of forces and of their mirror images, rms, N, and the sizes of their deformations.

    The sizes are relative to the largest one, which comes first.
    """
    settled = frame.settled_loads(forces)
    snapshots = np.hstack([settled, mirrored(frame, settled)])
    values, vectors = np.linalg.eigh(frame.deformation_energy(snapshots))
    size = np.sqrt(np.maximum(values[::-1], 0.0))
    keep = size > KEEP * size[0]
    loads = (snapshots @ vectors[:, ::-1][:, keep]) / np.sqrt(snapshots.shape[1])
    # left and right are equal: the first of them decides the sign
    large = np.abs(loads) > (1.0 - 1e-6) * np.abs(loads).max(axis=0)
    loads *= np.sign(loads[large.argmax(axis=0), np.arange(loads.shape[1])])
    return loads, size[keep] / size[0]


def write_loads(car: Car, names: Sequence[str], output: Path | None) -> None:
    """Simulate manoeuvres, decompose the forces, write the table of loads and print its path."""
    frame = car.flexible_frame
    forces = np.hstack([port_forces(car, name) for name in watched(names)])
    loads, sizes = principal_loads(frame, forces)
    manoeuvre_names = ", ".join(name.replace("_", " ") for name in names)
    lines = [
        f"# Loads of the {car.name} car's frame, N, most deforming first: principal combinations of interface forces,",
        f"# body axes, in {manoeuvre_names} and their mirror images; rms values.",
        "# Source: this engine, rigid car with ports; made by python -m benchmarks.frame loads",
        ",".join(["interface", "axis", *(f"load_{k + 1}" for k in range(loads.shape[1]))]),
    ]
    for k, row in enumerate(loads):
        lines.append(",".join([frame.interfaces[k // 3], "xyz"[k % 3], *(f"{v:.7g}" for v in row)]))
    file = output or frame.folder / (frame.section.loads or "loads.csv")
    write_text(file, "\n".join(lines) + "\n")
    sizes_text = np.array2string(sizes, precision=2)
    print(f"{2 * forces.shape[1]} snapshots, {loads.shape[1]} loads; sizes {sizes_text}")
    if frame.section.loads is None:
        print(f'{file}: add loads = "{file.name}" to [chassis.frame] of the car')
