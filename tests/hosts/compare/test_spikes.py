"""Single wrong samples of a log."""

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from benchmarks.validation.drive import read_drive
from hosts.compare.spikes import spikes

TIME = 0.01 * np.arange(2000)
FORM = Path(__file__).parents[3] / "benchmarks/validation/ferrari_250_lm_log.toml"


def slow(quantum: float) -> NDArray[np.float64]:
    """A steering angle with noise, in steps of a converter."""
    noise = 1e-4 * np.random.default_rng(3).normal(size=len(TIME))
    values = 0.1 * np.sin(0.7 * TIME) + noise
    return np.asarray(np.round(values / quantum) * quantum if quantum else values)


@pytest.mark.parametrize("quantum", [0.0, 2e-4, 2e-3])
def test_a_single_sample_is_found(quantum: float) -> None:
    values = slow(quantum)
    assert not spikes(TIME, values).any()
    values[[5, 700, 1990]] += [0.15, -0.15, 0.15]
    assert np.flatnonzero(spikes(TIME, values)).tolist() == [5, 700, 1990]


def test_real_events_are_kept() -> None:
    """A step, a kerb of three samples, an edge of a switch, and the quick return of a pedal at 20 Hz."""
    step, kerb = slow(0.0) + 0.2 * (TIME > 7.0), slow(0.0)
    kerb[500:503] += [0.1, 0.2, 0.1]
    pair = slow(0.0)
    pair[900:902] += 0.2
    switch = np.where((TIME > 3.0) & (TIME < 3.015), 1.0, 0.0)
    seldom = slow(0.0)
    seldom[700] += 0.15
    for values in (step, kerb, pair, switch):
        assert not spikes(TIME, values).any()
    assert not spikes(5.0 * TIME, seldom).any()
    assert spikes(2.0 * TIME, seldom).sum() == 1


def test_short_and_constant_signals_have_no_spikes() -> None:
    assert not spikes(TIME[:4], np.array([0.0, 5.0, 0.0, 0.0])).any()
    assert not spikes(TIME, np.zeros(len(TIME))).any()


def test_simple_models_do_not_see_it_either(tmp_path: Path) -> None:
    angle = slow(0.0)
    wrong = angle.copy()
    wrong[700] += 0.15
    rows = np.column_stack([TIME, wrong, wrong, 20.0 + 0.0 * TIME, 0.0 * TIME, angle, 0.0 * TIME])
    names = "time,road_wheel_angle_FL,road_wheel_angle_FR,vx,vy,yaw_rate,ay"
    np.savetxt(tmp_path / "log.csv", rows, delimiter=",", header=names, comments="")
    drive = read_drive(tmp_path / "log.csv", FORM)
    assert np.abs(drive.steer - angle).max() < 1e-3
    assert drive.steer[700] == pytest.approx(0.5 * (angle[699] + angle[701]))
