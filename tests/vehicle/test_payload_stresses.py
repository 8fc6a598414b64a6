"""The force of a payload reaches the gauges of a frame; load paths are those of a car without one."""

import numpy as np
import pytest

import mbs
from mbs.vehicle import load

PLACE = [-1.2, 0.35, 0.45]  # m
MASS = 80.0  # kg
LOADED = {"payload.driver.mass": MASS}
FIDELITIES = {"quasi_static": 0.05}
"""How far the change of a moment at rest may be from that of the dynamic frame, parts of the largest change."""


def moments(simulation: mbs.Simulation) -> np.ndarray:
    return np.array([v for n, v in simulation.sensors.items() if n.startswith("bending_moment.")])


def change(fidelity: str) -> np.ndarray:
    """Of the moments at rest, with the driver, N m."""
    car = load("prototype").changed({"payload.driver.mass": 0.0, "payload.driver.point": PLACE})
    system = mbs.compile(car.model(fidelity=fidelity))
    empty, loaded = (mbs.Simulation(system, parameters=values) for values in ({}, LOADED))
    weight = sum(loaded.sensors[f"wheel_{w}.Fz"] - empty.sensors[f"wheel_{w}.Fz"] for w in ("FL", "FR", "RL", "RR"))
    assert weight == pytest.approx(MASS * 9.81, abs=1e-5)
    return moments(loaded) - moments(empty)


@pytest.mark.slow
def test_moments_at_rest_change_with_a_payload_as_in_the_dynamic_frame() -> None:
    expected = change("dynamic")
    largest = np.abs(expected).max()
    assert largest > 0.5
    for fidelity, part in FIDELITIES.items():
        np.testing.assert_allclose(change(fidelity), expected, rtol=0, atol=part * largest, err_msg=fidelity)


@pytest.mark.slow
def test_a_car_that_is_loaded_is_one_rebuilt_with_the_load() -> None:
    values = {"payload.driver.mass": 0.0, "payload.driver.point": PLACE}
    for fidelity in ("quasi_static", "load_paths", "dynamic"):
        cars = [load("prototype").changed(values | more) for more in ({}, LOADED)]
        runs = [
            mbs.Simulation(
                mbs.compile(car.model(fidelity=fidelity)), parameters=parameters, pose=mbs.Pose(speed=10.0)
            ).run(0.5, 0.005, inputs={"steering": 0.3})
            for car, parameters in zip(cars, (LOADED, {}), strict=True)
        ]
        for name in runs[0]:
            scale = max(1.0, np.abs(runs[1][name]).max())
            if not name.startswith("solver."):
                np.testing.assert_allclose(runs[0][name], runs[1][name], rtol=0, atol=1e-9 * scale, err_msg=name)
