"""Output of a comparison: units of the field, and no rating where there is none."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib import pyplot as plt

from hosts.common.display_units import axis_shown, number_in, shown_number, titled
from hosts.compare.comparison import Comparison, compare
from hosts.compare.comparison_text import common_notes, delay_sentence, table
from hosts.compare.curve import Curve
from hosts.compare.report import bin_rows, comparison_figure
from hosts.compare.windows import bins
from hosts.driving.result import Result
from hosts.measures.signal import Signal

pytestmark = pytest.mark.drawn

TIME = np.linspace(0.0, 2.0, 201)


@pytest.fixture(scope="module")
def comparison() -> Comparison:
    """A yaw rate that is simulated 0.01 rad/s too large, and a constant measured number without a unit."""
    measured = {"chassis.wz": np.sin(3.0 * TIME), "gear": np.ones(201)}
    units = {"chassis.wz": "rad/s", "gear": "1"}
    values = np.column_stack([measured["chassis.wz"] + 0.01, measured["gear"] + 0.2])
    result = Result(list(measured), units, TIME, values, 1.0, 2.0, 0, [])
    signals = {n: Signal(n, n, units[n], TIME, y) for n, y in measured.items()}
    return compare(signals, {n: Curve(result, n) for n in measured}, 0.1)


def test_deviations_are_in_degrees(comparison: Comparison) -> None:
    head, yaw, gear = table(comparison).splitlines()
    assert head.split()[:3] == ["signal", "unit", "rms"]
    assert yaw.split()[:3] == ["chassis.wz", "deg/s", "0.573"]
    assert gear.split()[:2] == ["gear", "0.2"]


def test_a_drift_is_reported_where_it_is_one(comparison: Comparison) -> None:
    """In the terminal and on the page by the same sentence."""
    clock = replace(comparison.common, delay=0.01, delay_error=1e-4, drift=-3e-4, drift_error=1e-5, explained=0.9)
    message = delay_sentence(Comparison(comparison.signals, clock))
    assert message == (
        "All signals together: the log is 10 ± 0.1 ms late; the clock of its outputs runs 300 ± 10 ppm slow against "
        "that of its inputs, which explains 90 % of what a delay leaves."
    )
    assert common_notes(Comparison(comparison.signals, clock))[-1] == message
    model = Comparison(comparison.signals, replace(clock, explained=0.05))
    assert delay_sentence(model) == (
        "All signals together: the log is 10 ± 0.1 ms late. "
        "1 of 2 signals have another delay, 'chassis.wz' farthest, 0 ms."
    )


def test_a_signal_without_a_delay_does_not_count_in_the_common_delay() -> None:
    """Noise beside a turn that is 30 ms late."""
    noise, other = np.random.default_rng(3).normal(size=(2, 201))
    turn = np.sin(3.0 * TIME) + np.sin(7.0 * TIME)
    result = Result(["turn", "noise"], {}, TIME, np.column_stack([turn, other]), 1.0, 2.0, 0, [])
    late = np.sin(3.0 * (TIME - 0.03)) + np.sin(7.0 * (TIME - 0.03))
    signals = {n: Signal(n, n, "1", TIME, y) for n, y in {"turn": late, "noise": noise}.items()}
    actual = compare(signals, {n: Curve(result, n) for n in signals}, 0.1).common
    assert actual.delay == pytest.approx(0.03, abs=1e-5)
    assert actual.correlation == pytest.approx(1.0, abs=1e-6)


def test_deviations_by_speed_are_in_the_same_units(comparison: Comparison) -> None:
    scales = {"speed": Signal("", "", "m/s", TIME, np.full(201, 15.0))}
    rows = bin_rows(bins(comparison, scales), comparison)
    assert rows[0] == ["chassis.wz", "deg/s", "speed, km/h", "36 to 72", "201", "0.573", "0.573"]
    assert rows[1][:3] == ["gear", "", "speed, km/h"]


@pytest.mark.slow
def test_the_picture_omits_undefined_ratings(comparison: Comparison) -> None:
    figure = comparison_figure(comparison, None, "a drive", {})
    titles = [axes.get_title(loc) for axes in figure.axes for loc in ("left", "center")]
    assert "chassis.wz, deg/s" in titles
    assert any(t.startswith("simulated − measured: rms 0.573 deg/s; rating ") for t in titles)
    assert "simulated − measured: rms 0.2" in titles
    lines = figure.axes[0].get_lines()
    assert max(lines[0].get_ydata()) == pytest.approx(np.degrees(1.0), rel=1e-3)
    assert max(lines[1].get_ydata()) == pytest.approx(np.degrees(1.01), rel=1e-3)
    plt.close(figure)


def test_a_spike_of_a_long_log_is_drawn() -> None:
    time = np.linspace(0.0, 200.0, 20001)
    values = np.sin(time)
    values[7777] = 9.0
    result = Result(["x"], {"x": "m"}, time, np.sin(time)[:, None], 200.0, 2.0, 0, [])
    found = compare({"x": Signal("x", "x", "m", time, values)}, {"x": Curve(result, "x")}, 0.1)
    figure = comparison_figure(found, None, "a drive", {})
    drawn = figure.axes[0].get_lines()[0].get_ydata()
    assert (len(drawn) < 5000, max(drawn)) == (True, 9.0)
    plt.close(figure)


def test_a_number_without_a_unit_is_shown_without_one() -> None:
    assert number_in(1.2, "1") == "1.2"
    assert number_in(1.2, "kg") == "1.2 kg"
    assert shown_number(0.5, "m/s", "speed") == "1.8 km/h"
    assert titled("gear", "1") == titled("gear", "") == "gear"
    assert titled("mass", "kg") == "mass, kg"
    assert titled("yaw acceleration", "rad/s2") == "yaw acceleration, rad/s²"
    assert axis_shown("yaw acceleration, rad/s2")[0] == "yaw acceleration, deg/s²"
    assert axis_shown("gain, 1")[0] == "gain"
    assert axis_shown("share of m2") == ("share of m2", 1.0)
