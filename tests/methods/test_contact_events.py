"""Steps end where a stop is met or left: errors fall with the square of the step through each impact."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import mbs
from mbs.elements import EndStops, SpringDamper

Array = NDArray[np.float64]
SPAN = 1.2  # s
STEPS = (0.008, 0.004, 0.002, 0.001)  # s
GAPS = np.linspace(0.011, 0.047, 7)  # m


def between_stops(gap: float) -> mbs.System:
    """A mass of 1 kg on a line without a spring, but for stops `gap` to both sides."""
    m = mbs.Model("mass between stops", dimension=2, gravity=(0.0, 0.0))
    mass = m.point_mass("mass", mass=1.0, position=(1.0, 0.0))
    m.point_on_line("line", (mass, (1.0, 0.0)), (m.ground, (1.0, 0.0)), axis=(1.0, 0.0))
    m.initial_velocity(mass, linear=(1.0, 0.0))
    stops = EndStops(1.0 - gap, 4e3, 1.0 + gap, 4e3)
    m.add(SpringDamper(0.0, 0.0, 1.0, stops).record("stops", mass.point() - m.ground.point((0.0, 0.0))))
    m.sense_position("x", mass, None, "x")
    return mbs.compile(m)


def exact(gap: float, t: Array) -> Array:
    def rates(_: float, y: Array) -> Array:
        beyond = abs(y[0]) - gap
        return np.array([y[1], -4e3 * np.sign(y[0]) * max(beyond, 0.0)])

    solution = solve_ivp(
        rates, (0.0, SPAN), [0.0, 1.0], t_eval=t, method="DOP853", rtol=1e-10, atol=1e-11, max_step=2e-3
    )
    return np.asarray(1.0 + solution.y[0])


def errors(system: mbs.System, expected: Array, settings: mbs.Settings | None = None) -> Array:
    """At the times of the longest steps."""
    results = []
    for h in STEPS:
        every = round(STEPS[0] / h)
        run = mbs.simulate(system, SPAN, h, every=every, settings=settings, estimate_error=False, progress=False)
        results.append(float(np.abs(run["x"] - expected).max()))
    return np.array(results)


def orders(found: Array) -> Array:
    return np.asarray(np.log2(found[..., :-1] / found[..., 1:]))


@pytest.mark.slow
def test_every_impact_keeps_order_two_where_whole_steps_have_it_on_the_mean_only() -> None:
    whole = mbs.Settings(max_halvings=0)
    located, unlocated = [], []
    for gap in GAPS:
        system, expected = (
            between_stops(float(gap)),
            exact(float(gap), STEPS[0] * np.arange(round(SPAN / STEPS[0]) + 1)),
        )
        located.append(errors(system, expected))
        unlocated.append(errors(system, expected, whole))
    kept, lost = orders(np.array(located))[:, 1:], orders(np.array(unlocated))[:, 1:]
    assert np.median(kept) > 1.8
    assert np.quantile(kept, 0.25) > 1.7
    assert np.ptp(kept) < 0.5 * np.ptp(lost)


@pytest.mark.parametrize(("method", "order"), [("runge_kutta_8", 3.3), ("radau_5", 2.5), ("energy_momentum_4", 3.7)])
def test_impacts_in_steps_of_high_order_keep_more_than_order_two(method: str, order: float) -> None:
    """Whole steps of 8 ms are off by 0.3 % of the way and more by the first two."""
    found = []
    for gap in GAPS[::3]:
        expected = exact(float(gap), STEPS[0] * np.arange(round(SPAN / STEPS[0]) + 1))
        found.append(errors(between_stops(float(gap)), expected, mbs.Settings(method=method)))
    assert np.median(np.log2(np.array(found)[:, 0] / np.array(found)[:, -1]) / 3.0) > order
    assert np.max(found, axis=0)[0] < 1e-4


def test_a_located_event_is_counted_and_loses_no_energy() -> None:
    run = mbs.simulate(between_stops(0.02), SPAN, 0.002, estimate_error=False, progress=False)
    assert run.report is not None
    assert run.report.divisions > 20
    assert run.report.halvings == 0
    free = np.abs(run["x"] - 1.0) < 0.015
    speed = np.abs(np.gradient(run["x"], run.t))[free]
    assert speed == pytest.approx(np.ones(len(speed)), abs=5e-3)


@pytest.mark.parametrize(("method", "h"), [("runge_kutta_8", 0.05), ("radau_5", 0.1)])
def test_an_event_in_a_part_that_may_not_be_halved_is_reported_and_does_not_end_the_run(method: str, h: float) -> None:
    """Its step was refused as one whose energy balance is violated."""
    settings = mbs.Settings(method=method, max_halvings=1)
    run = mbs.simulate(between_stops(0.05), 6.0, h, settings=settings, estimate_error=False, progress=False)
    assert run.t[-1] == pytest.approx(6.0)
    assert run.report is not None
    assert run.report.halvings > 0
    assert run.report.abrupt_steps > 0


def test_lanes_and_a_saved_state_have_the_bits_of_a_single_run() -> None:
    """Before, between and behind steps that are divided."""
    system, h = between_stops(0.02), 0.004
    run = mbs.simulate(system, SPAN, h, estimate_error=False, progress=False)
    many = mbs.simulate_many(system, [mbs.Variant(), mbs.Variant()], SPAN, h, estimate_error=False, progress=False)
    for part, alone in zip(many.trajectories, many.alone, strict=True):
        assert part is not None
        assert (part["x"] == run["x"]).all()
        assert part.report.divisions == run.report.divisions
        assert alone > 0
    by_hand = mbs.Simulation(system)
    for _ in range(50):
        state = by_hand.save()
        by_hand.step(h)
        ended = by_hand.save()
        by_hand.restore(state)
        by_hand.step(h)
        assert by_hand.save() == ended
    assert by_hand.report.divisions > 3


@pytest.mark.parametrize("method", ["ali3p", "energy_momentum_4"])
def test_abrupt_forces_do_not_depend_on_the_recorded_sensors(method: str) -> None:
    """Steps that nothing reads had no forces, so that stops were seen at samples only."""
    system, seen = between_stops(0.1), []
    for every in (1, 7, 700):
        simulation = mbs.Simulation(system, settings=mbs.Settings(method=method))
        simulation.run(1.4, 0.002, every=every, estimate_error=False, progress=False)
        report = simulation.instance.report()
        seen.append((report["abrupt_steps"], report["largest_force"]))
    assert seen[0][0] > 0
    assert seen == [seen[0]] * 3
