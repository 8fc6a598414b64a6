"""Forces at the interfaces of the car's frame in its manoeuvres."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from benchmarks.car import fidelity_runs, manoeuvres
from mbs import Simulation
from mbs.input_signals import InputSignals
from mbs.scenes import prototype_car
from mbs.vehicle import Fidelity

INTERFACES = prototype_car.car().flexible_frame.interfaces

GUIDED = "kerb_test"
H, EVERY = 0.005, 4


def port_forces(name: str) -> NDArray[np.float64]:
    """Forces on the chassis at the interfaces in its axes through a manoeuvre, shape (60, samples), N."""
    manoeuvre = fidelity_runs.manoeuvre_of(name) if name == GUIDED else manoeuvres.load(name)
    system = fidelity_runs.system_of(name, Fidelity.QUASI_STATIC)
    parameters, pose = manoeuvres.start_of(manoeuvre, system)
    signals = InputSignals(manoeuvres.inputs_of(manoeuvre, system), system.meta["inputs"])
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
