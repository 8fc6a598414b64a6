"""Free wheels that gears, racks and screws tie: energy, teeth and angles over long runs."""

import numpy as np
import pytest

import mbs
from benchmarks.methods.free_runs import STEPS, TURNS, measure
from benchmarks.methods.free_wheels import WHEELS, Free, alone_late

NAMES = pytest.mark.parametrize("name", WHEELS)


def check(name, turn, steps, method="ali3p"):
    result = measure(name, turn, steps, method)
    assert result["energy"] < 1e-3 * (turn / 0.5) ** 4 + 1e-9, result
    assert result["slip"] < 1e-11, result
    assert result["late"] < alone_late(turn), result
    return result


@NAMES
def test_wheels_keep_energy_and_teeth_do_not_slip(name):
    for turn in (0.1, 0.5):
        check(name, turn, 300)


@pytest.mark.proof
def test_wheels_keep_energy_for_a_hundred_thousand_steps():
    for name in WHEELS:
        for turn in TURNS:
            check(name, turn, STEPS)


@pytest.mark.parametrize("turn", [0.6, 3.0])
def test_steps_in_which_wheels_turn_far_are_halved_or_refused(turn):
    result = measure("pair, ratio -3", turn, 100)
    assert result["energy"] < 1e-3
    assert result["halvings"] >= 100
    system = mbs.compile(WHEELS["armature"](turn / 0.01).model)
    with pytest.raises(mbs.SimulationError, match=r"turns by more than 0\.52 rad .* a step of 0\.00\d+ s follows it"):
        mbs.simulate(system, 1.0, 0.01, settings=mbs.Settings(max_halvings=0), progress=False)


def test_a_wheel_alone_keeps_its_rate_and_is_late():
    """An angle that carries nothing is no reason to open its row."""
    wheels = Free()
    wheels.angle("angle", wheels.model.ground, wheels.wheel("wheel", 0.1), 50.0)
    wheels.model.sense_coordinate("rate", wheels.angles["angle"][0], order=1)
    r = mbs.simulate(wheels.compiled(), 1.0, 0.01, progress=False, estimate_error=False)
    assert np.ptp(r["energy"]) < 1e-9 * r["energy"][0]
    assert np.ptp(r["rate"]) < 1e-7
    assert 1.0 - r["angle"][-1] / 50.0 == pytest.approx(alone_late(0.5), rel=1e-6)
