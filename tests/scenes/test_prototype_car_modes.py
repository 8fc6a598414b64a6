"""Prototype car: natural frequencies of the linear model against a model of four masses without constraints."""

from dataclasses import replace

import numpy as np
import pytest

from mbs import Simulation, compile, linearise
from mbs.elements.road import PlaneRoad
from mbs.scenes import prototype_car
from mbs.vehicle.tyres.tmeasy import TMeasy
from tests.scenes.car import NEUTRAL, car, car_on_ice

# the figures take the parts of the suspension as points and leave the damping of the tyres out
RIDE = ((1.16, 0.27), (1.49, 0.33))  # Hz, damping ratio
HOP = ((7.7, 0.35), (8.1, 0.18))  # rear, front
FREQUENCY = 0.015
RIDE_DAMPING = 0.015
HOP_DAMPING = 0.02
SYMMETRIC = 1e-3  # roll in a mode without roll; in the others it is above 0.1


def symmetric_modes(system):
    """Oscillations in which the car does not roll, below 9 Hz, as (Hz, damping ratio)."""
    model = linearise(Simulation(system, parameters=NEUTRAL), side=1)  # the engine drags forwards only
    assert model.degrees_of_freedom == 14
    roll = model.coordinates.index("chassis.bz")
    results = [m for m in model.oscillating_modes() if m.frequency_hz < 9.0 and abs(m.shape[roll]) < SYMMETRIC]
    return [(m.frequency_hz, m.damping_ratio) for m in results]


def test_ride_and_wheel_hop(monkeypatch):
    original = TMeasy.tyre
    monkeypatch.setattr(TMeasy, "tyre", lambda self, *side: replace(original(self, *side), damping=0.0))
    modes = symmetric_modes(compile(prototype_car.build(PlaneRoad(friction=0.0))))
    assert len(modes) == 4
    for (f, zeta), (expected_f, expected_zeta) in zip(modes[:2], RIDE, strict=True):
        assert f == pytest.approx(expected_f, rel=FREQUENCY)
        assert zeta == pytest.approx(expected_zeta, abs=RIDE_DAMPING)
    for (f, zeta), (expected_f, expected_zeta) in zip(modes[2:], HOP, strict=True):
        assert f == pytest.approx(expected_f, rel=FREQUENCY)
        assert zeta == pytest.approx(expected_zeta, abs=HOP_DAMPING)


@pytest.mark.slow
def test_tyre_damping_damps_the_hop_only(monkeypatch):
    with_damping = symmetric_modes(car_on_ice())
    original = TMeasy.tyre
    monkeypatch.setattr(TMeasy, "tyre", lambda self, *side: replace(original(self, *side), damping=0.0))
    without = symmetric_modes(compile(prototype_car.build(PlaneRoad(friction=0.0))))
    rise = np.array(with_damping)[:, 1] - np.array(without)[:, 1]
    assert np.all(np.abs(rise[:2]) < 0.01)
    assert np.all(rise[2:] > 0.05)


def test_nothing_is_unstable_at_rest_and_the_free_motions_are_free():
    model = linearise(Simulation(car(), parameters=NEUTRAL), side=1)  # the engine drags forwards only
    assert model.degrees_of_freedom == 14
    assert all(m.eigenvalue.real < 1e-3 for m in model.modes)
    assert sum(abs(m.eigenvalue) < 1e-2 for m in model.modes) >= 5  # rolling and the free spins


def test_on_ice_the_standing_car_is_as_free_as_without_horizontal_forces():
    """A grip of next to nothing would hold a standing wheel within micrometres per second: 1.58 in place of 1.97 Hz."""
    model = linearise(Simulation(car_on_ice(), parameters=NEUTRAL), side=1)
    third = model.oscillating_modes()[2]
    assert third.frequency_hz == pytest.approx(1.971, rel=0.01)
    assert third.damping_ratio == pytest.approx(0.485, abs=0.01)
