"""Signals that are judged in a run: those at rest or prescribed are not, and do not disable others."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline, PPoly

import mbs
from mbs.elements import ScalarSpringDamper
from mbs.results.comparison import Compared, Comparison, differences, select_compared, sizes_of

RATE, PLACE = Compared("rad/s", always=False), Compared("m", place=True)
T = np.linspace(0.0, 1.0, 101)


@pytest.mark.parametrize("beside", ["", "a resting centre", "a resting centre alone"])
def test_a_body_that_tumbles_beside_a_sensor_at_rest_is_reported(beside: str) -> None:
    """About its middle axis, 0.1 s steps: rates are off by their range; the resting centre silenced that."""
    m = mbs.Model("tumbling body", gravity=(0.0, 0.0, 0.0))
    body = m.body("body", mass=1.0, com=(0.0, 0.0, 0.0), inertia=np.diag([0.1, 0.2, 0.3]))
    m.initial_velocity(body, linear=(0.0, 0.0, 0.0), angular=(0.01, 5.0, 0.01))
    for c in "xyz" if beside else "":
        m.sense_position(f"centre.{c}", body, None, c)
    for c in "xyz" if "alone" not in beside else "":
        m.sense_rotation(f"rate.{c}", body, c, order=1)
    with pytest.warns(mbs.AccuracyWarning, match="coordinate" if "alone" in beside else "rate"):
        run = mbs.simulate(mbs.compile(m), 20.0, 0.05, progress=False)
    assert run.accuracy is not None
    assert set(run.accuracy.units) == {"1" if "alone" in beside else "rad/s"}


def arm(rate: float, beside: str) -> mbs.System:
    """A driven arm with a rod that swings on it: the prescribed angle, its torque and the rate of the rod."""
    m = mbs.Model("arm", dimension=2)
    first = m.body("first", mass=1.0, com=(0.5, 0.0), inertia=0.1)
    rod = m.body("rod", mass=2.0, com=(1.25, 0.0), inertia=0.05)
    m.revolute("pin", m.ground, first, point=(0.0, 0.0))
    m.revolute("joint", first, rod, point=(1.0, 0.0))
    angle = m.relative_angle("angle", m.ground, first)
    drive = m.drive("drive", angle, m.guide_time("turn", PPoly([[rate], [0.0]], [0.0, 10.0]), unit="rad"))
    if beside == "motor.angle":
        m.sense_coordinate("motor.angle", angle)
    else:
        m.sense_position("tip", first, (1.0, 0.0), "x")
    m.sense_joint("motor.torque", drive, "drive")
    m.sense_rotation("rod.rate", rod, "z", order=1)
    return mbs.compile(m)


@pytest.mark.parametrize("beside", ["motor.angle", "tip"])
def test_what_a_guide_prescribes_switches_rates_and_the_torque_of_its_motor_on(beside: str) -> None:
    """Also where it is no linear function of what is driven, as the tip of the arm: it silenced the rod's rate."""
    system = arm(4.0, beside)
    with pytest.warns(mbs.AccuracyWarning, match=r"off by .*'(rod\.rate|motor\.torque)'"):
        run = mbs.simulate(system, 3.0, 0.05, progress=False)
    assert run.accuracy is not None
    assert set(run.accuracy.sensors) == {beside, "motor.torque", "rod.rate"}
    fine = mbs.simulate(system, 3.0, 0.0005, every=100, progress=False, estimate_error=False)
    size = np.ptp(fine["rod.rate"])
    assert run.accuracy.sensors["rod.rate"] / size == pytest.approx(
        np.abs(run["rod.rate"] - fine["rod.rate"]).max() / size, rel=0.5
    )


def test_rates_are_judged_where_no_place_moves_by_itself() -> None:
    """Without driving functions each place that moves does; with them two motions say so."""
    candidates = {"x": PLACE, "rate": RATE}
    values = {"x": np.sin(T), "rate": np.cos(9.0 * T)}
    assert set(select_compared(values, candidates, 1.0)) == {"x"}
    assert set(select_compared(values, candidates, 1.0, guided=True)) == {"x", "rate"}
    still = values | {"x": 0.0 * T}
    assert set(select_compared(still, candidates, 1.0)) == {"rate"}
    assert set(select_compared(still, candidates, 1.0, at_rest=True)) == set()
    other = values | {"rate": np.cos(8.0 * T)}
    for moved, units in ((0.0, {"m", "rad/s"}), (1e-3, {"m"})):
        actual, gaps, sizes = differences(values, other | {"x": (1.0 + moved) * values["x"]}, candidates, None, 1.0)
        assert set(actual) == units
        assert set(gaps) == set(sizes)


def test_angles_from_minus_pi_to_pi_are_compared_as_angles() -> None:
    angle, turns = Compared("rad", place=True, wrapped=True), 20.0 * T
    wrapped = (turns + np.pi) % (2.0 * np.pi) - np.pi
    late = (turns - 0.3 + np.pi) % (2.0 * np.pi) - np.pi
    assert np.abs(wrapped - late).max() > 5.0
    units, sensors, sizes = differences({"a": late}, {"a": wrapped}, {"a": angle}, None, 1.0)
    assert sensors["a"] == pytest.approx(0.3)
    assert sizes["a"] == pytest.approx(20.0)
    assert units["rad"] == pytest.approx(0.015)
    assert set(select_compared({"a": wrapped}, {"a": angle}, 1.0)) == {"a"}
    assert set(select_compared({"a": wrapped[::10]}, {"a": angle}, 1.0)) == set()
    turning = {"a": wrapped[::10], "turning": 0.1 * T[::10]}  # one that is not followed is no size of others
    assert differences(turning, turning, {"a": angle, "turning": Compared("rad", place=True)}, None, 1.0)[2] == {
        "turning": pytest.approx(0.1)
    }


def test_an_angle_continues_from_the_turns_of_earlier_runs() -> None:
    angle = {"a": Compared("rad", place=True, wrapped=True)}
    first = Comparison(angle, 1.0)
    for begin, end in ((0.0, 10.0), (10.0, 16.0)):
        second = Comparison(angle, 1.0, first.ends)
        turns = {"a": (begin + (end - begin) * T + np.pi) % (2.0 * np.pi) - np.pi}
        second.add(turns, {"a": turns["a"] + 0.2})
        assert second.gaps["a"] == pytest.approx(0.2)
        first = second
    assert first.sizes()["a"] == pytest.approx(16.0)
    assert {name: seen.gap for name, seen in first.ends.items()} == {"a": 0.0}


def test_unknown_values_and_missing_samples_are_skipped() -> None:
    both = {"x": PLACE, "load": Compared("N", load=True)}
    fine = {"x": 1.0 * np.arange(6.0), "load": 10.0 + np.arange(6.0)}
    coarse = {"x": fine["x"] + np.array([0.0, 0.1, np.nan, 0.0, 0.0, 9.0]), "load": fine["load"] + np.arange(6.0)}
    comparison = Comparison(both, 1.0)
    comparison.add(fine, {name: values[:5] for name, values in coarse.items()})
    assert comparison.gaps == pytest.approx({"x": 0.1, "load": 4.0})
    assert comparison.sizes() == pytest.approx({"x": 5.0, "load": 15.0})
    comparison.widen({"x": 0.5, "load": 2.0})
    assert comparison.gaps == pytest.approx({"x": 0.5, "load": 4.0})


def test_errors_are_held_against_the_largest_range_in_the_unit() -> None:
    values = {"large": 1000.0 + 10.0 * np.sin(9.0 * T), "small": 1e-3 * T, "load": 5.0 + T, "rest": 0.0 * T}
    actual = sizes_of(
        values, {"large": PLACE, "small": PLACE, "load": Compared("N", load=True), "rest": RATE}, length=1.0
    )
    assert actual == pytest.approx({"large": 20.0, "small": 20.0, "load": 6.0}, rel=1e-3)


def test_a_place_that_rests_in_the_finer_motion_is_compared_where_the_other_moves() -> None:
    """Held against what the finer motion does alone, a body that leaves where it should stay was off by nothing."""
    compared = {"x": PLACE, "load": Compared("N", load=True)}
    rests = {"x": 1.0 + 3e-5 * np.sin(T), "load": 5.0 + T}
    units, _, sizes = differences(rests | {"x": 1.0 + 0.2 * T}, rests, compared, None, 1.0)
    assert units["m"] == pytest.approx(1.0)
    assert sizes["x"] == pytest.approx(0.2, rel=1e-3)
    assert "m" not in differences(rests | {"x": 1.0 - 3e-5 * np.sin(T)}, rests, compared, None, 1.0)[0]


def test_sensors_in_other_units_of_a_quantity_are_compared_and_the_rest_have_an_estimate() -> None:
    """The tip in mm is off by a tenth of its range, and the resting end of a link, in m, was all that was judged."""
    m, turn = mbs.Model("two links", dimension=2), 180.0 / np.pi
    links = [m.body(name, mass=1.0, com=(x, 0.0), inertia=0.01) for name, x in (("one", 0.15), ("two", 0.45))]
    m.revolute("hip", m.ground, links[0], point=(0.0, 0.0))
    m.revolute("knee", *links, point=(0.3, 0.0))
    angles = m.relative_angle("hip angle", m.ground, links[0]), m.relative_angle("knee angle", *links)
    for angle, rate in zip(angles, (8.0, -20.0), strict=True):
        m.initial_rate(angle, rate)
    tip = links[1].point((0.6, 0.0))
    m.sense_coordinate("knee", turn * angles[1].affine, unit="deg")
    m.sense_coordinate("tip", 1000.0 * tip[0], unit="mm")
    m.sense_coordinate("tip.speed", 3.6 * tip[0], order=1, unit="km/h")
    m.sense_position("hub", links[0], (1e-3, 0.0), "x")
    system = mbs.compile(m)
    fine = mbs.simulate(system, 1.0, 1e-4, every=100, estimate_error=False, progress=False)
    with pytest.warns(mbs.AccuracyWarning, match=r"'tip' by \d+\.?\d* mm of"):
        run = mbs.simulate(system, 1.0, 0.01, progress=False)
    assert run.accuracy is not None
    assert set(run.accuracy.units) == {"m", "rad"}
    assert set(run.accuracy.others) == {"tip.speed"}
    for name, error in (run.accuracy.sensors | run.accuracy.others).items():
        if name != "hub":
            assert error == pytest.approx(np.abs(run[name] - fine[name]).max(), rel=0.3)


@pytest.mark.parametrize(("largest", "judged"), [(1e-6, {"x", "spring"}), (1.0, {"x", "spring", "motor"})])
def test_the_force_of_a_motor_is_round_off_beside_large_forces(largest: float, judged: set[str]) -> None:
    """A rack that is held straight has 1e-6 N beside springs with 3000 N, and twice that in another motion."""
    compared = {"x": PLACE, "spring": Compared("N", load=True), "motor": Compared("N", load=True, always=False)}
    fine = {"x": T, "spring": 3000.0 + T, "motor": largest * np.sin(9.0 * T)}
    assert set(differences(fine | {"motor": 2.0 * fine["motor"]}, fine, compared, None, 1.0)[1]) == judged


def test_a_small_turn_counts_where_nothing_else_moves() -> None:
    judged = {"turn": Compared("rad", place=True), "x": PLACE}
    values = {"turn": 5e-4 * np.sin(9.0 * T), "x": np.sin(T)}
    assert set(select_compared(values, judged, 1.0)) == {"x"}
    assert set(select_compared(values | {"x": 0.0 * T}, judged, 1.0)) == {"turn"}
    assert set(select_compared(values | {"turn": 3.0 * values["turn"]}, judged, 1.0)) == {"turn", "x"}


@pytest.mark.parametrize("kind", ["drive", "moment"])
def test_the_torque_of_a_motor_is_compared_where_no_other_sensor_moves(kind: str) -> None:
    """What it drives is right at each sample, its torque J a off by 10 % at 0.8 rad a step; also as "N.m"."""
    m = mbs.Model("motor", gravity=(0.0, 0.0, 0.0))
    disc = m.body("disc", mass=2.0, com=(0.0, 0.0, 0.0), inertia=np.eye(3) * 0.5)
    m.revolute("bearing", m.ground, disc, point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0))
    angle = m.relative_angle("angle", m.ground, disc, axis=(0.0, 0.0, 1.0))
    t = np.linspace(0.0, 2.0, 509)
    turn = CubicSpline(t, np.sin(40.0 * t))
    drive = m.drive("drive", angle, m.guide_time("turn", PPoly(turn.c, turn.x), unit="rad"))
    m.sense_joint("torque", drive, "drive" if kind == "drive" else "z", "moment" if kind == "moment" else "force")
    with pytest.warns(mbs.AccuracyWarning, match="'torque'"):
        run = mbs.simulate(mbs.compile(m), 1.5, 0.02, progress=False)
    exact = 0.5 * turn(run.t, 2)
    assert run.accuracy is not None
    assert np.abs(run["torque"] - exact).max() == pytest.approx(run.accuracy.sensors["torque"], rel=0.2)


def test_the_torque_of_a_shaft_is_compared() -> None:
    """Two inertias turn at 100 rad/s and swing against each other: their angles are right, their torque is not."""
    m = mbs.Model("drivetrain", dimension=2, gravity=(0.0, 0.0))
    m.body("housing", mass=1.0, com=(0.0, 0.0), inertia=1.0)
    engine, load = m.shaft("engine", inertia=0.2), m.shaft("load", inertia=0.05)
    m.initial_rate(engine, 100.0)
    m.initial_rate(load, 103.0)
    shaft = m.add(ScalarSpringDamper(stiffness=2e4).record("shaft", load.affine - engine.affine))
    m.sense_element("torque", shaft, "force")
    with pytest.warns(mbs.AccuracyWarning, match="'torque'"):
        mbs.simulate(mbs.compile(m), 1.0, 0.002, progress=False)
