"""Springs and dampers by table, against scipy's monotone cubic and its integral."""

import re
import warnings
from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from mbs import AccuracyWarning, Model, Settings, System, Trajectory, compile, simulate
from mbs.elements import EndStops, PlaneRoad, SpringDamper, SpringDamperTable
from mbs.elements.spring_damper_table import force_of_table
from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.settings.methods import METHOD_TABLE
from tests.elements.harness import Array, Element, vectors

SPRING = np.array(
    [(-0.15, -9000.0), (-0.10, -3000.0), (-0.02, -500.0), (0.0, 0.0), (0.05, 700.0), (0.051, 700.0), (0.2, 1500.0)]
)
DAMPER = np.array([(-1.5, -2100.0), (-0.3, -900.0), (-0.05, -300.0), (0.0, 0.0), (0.1, 150.0), (1.0, 500.0)])
FREE = 0.4
ROUND_OFF = 1e-12


def element(spring: object = SPRING, damper: object = 0.0, free_length: float = FREE, **more: object) -> Element:
    strut = SpringDamperTable(spring, damper, free_length, **more)  # type: ignore[arg-type]
    return Element(strut.record("strut", vectors(3)[0]))


def along(length: float, rate: float = 0.0) -> tuple[Array, Array]:
    n = np.array([0.48, 0.6, 0.64])
    return length * n, rate * n


def reference(rows: Array, x: float) -> tuple[float, float]:
    """Value and integral from 0, straight beyond the ends."""
    curve = PchipInterpolator(*rows.T)
    end = float(np.clip(x, rows[0, 0], rows[-1, 0]))
    slope = float(curve.derivative()(end))
    value = float(curve(end)) + slope * (x - end)
    return value, float(curve.integrate(0.0, end)) + (x - end) * (float(curve(end)) + 0.5 * slope * (x - end))


@pytest.mark.parametrize("x", [-0.35, -0.15, -0.13, -0.1, -0.05, 0.0, 0.02, 0.0504, 0.051, 0.19, 0.2, 0.5])
def test_force_and_energy_of_the_spring_are_those_of_scipy(x):
    force, energy = reference(SPRING, x)
    r = element()(*along(FREE + x))
    assert r.out["force"] == pytest.approx(force, rel=ROUND_OFF, abs=1e-8)
    assert r.potential == pytest.approx(energy, rel=1e-11, abs=1e-9)


@pytest.mark.parametrize("v", [-3.0, -1.5, -0.7, -0.05, -0.01, 0.0, 0.05, 0.4, 1.0, 5.0])
def test_the_force_of_the_damper_is_that_of_scipy_and_takes_energy(v):
    force, _ = reference(DAMPER, v)
    r = element(0.0, DAMPER)(*along(FREE, v))
    assert r.out["force"] == pytest.approx(force, rel=ROUND_OFF, abs=1e-9)
    assert force_of_table(DAMPER, v) == pytest.approx(r.out["damper_force"], rel=ROUND_OFF, abs=1e-9)
    assert r.f @ along(FREE, v)[1] <= 0.0
    assert r.potential == 0.0


@pytest.mark.parametrize(
    "rows", [SPRING + np.array([0.3, 5000.0]), SPRING - np.array([0.3, 0.0]), SPRING[:2], SPRING[-2:]]
)
def test_the_energy_counts_from_stretch_nought_wherever_the_table_lies(rows):
    bench = element(rows)
    assert bench(*along(FREE)).potential == pytest.approx(0.0, abs=1e-8 * np.max(np.abs(rows[:, 1])))
    for x in (-0.3, 0.05, 0.3):
        ahead, behind = (bench(*along(FREE + x + d)).potential for d in (1e-6, -1e-6))
        force = bench(*along(FREE + x)).out["force"]
        assert (ahead - behind) / 2e-6 == pytest.approx(force, rel=1e-6, abs=1e-3)


def test_a_straight_table_is_the_number():
    stops = EndStops(0.3, 8e4, 0.5, 5e4, bump_progression=0.03, metal_stiffness=1e6, bump_travel=0.05, bump_loss=0.2)
    straight = SpringDamperTable([(-0.1, -1000.0), (0.1, 1000.0)], [(-1.0, -300.0), (0.0, 0.0), (1.0, 300.0)], FREE)
    plain = Element(SpringDamper(1e4, 300.0, FREE, stops).record("s", vectors(3)[0]))
    for strut in (straight, SpringDamperTable(1e4, 300.0, FREE)):
        table = Element(replace(strut, stops=stops).record("s", vectors(3)[0]))
        rng = np.random.default_rng(3)
        for length in (0.2, 0.29, 0.4, 0.55):
            u, ud = along(length, 0.3)
            ud = ud + 0.1 * rng.normal(size=3)
            for discrete in (False, True):
                a, b = (e(u, ud, None, 0.01, 0.005, 2.5e-5, discrete=discrete) for e in (plain, table))
                assert np.allclose(a.f, b.f, rtol=1e-11)
                assert np.allclose(a.S, b.S, rtol=1e-8)


@pytest.mark.parametrize("ends", [(-0.2, 0.3), (-0.12, -0.11), (0.04, 0.06), (0.3, -0.3), (0.05, 0.05), (0.01, 0.0101)])
def test_a_step_takes_the_change_of_the_energy_exactly_and_its_tangent_is_the_derivative(ends):
    h = 0.01
    bench = element(SPRING, 0.0, stiffness_factor=1.3)
    u0, u1 = (along(FREE + x)[0] for x in ends)

    def step(end: Array, wK: float = 0.0) -> tuple[Array, Array]:
        r = bench(0.5 * (u0 + end), (end - u0) / (2.0 * h), None, h, 0.0, wK, discrete=True)
        return r.f, r.S

    f, S = step(u1, 1.0)
    before, after = (bench(u, np.zeros(3)).potential for u in (u0, u1))
    assert f @ (u1 - u0) == pytest.approx(before - after, rel=1e-11, abs=1e-9)
    if abs(ends[1] - ends[0]) < 1e-3:
        return
    n, shift = along(1.0)[0], 1e-6
    slope = -(step(u1 + shift * n)[0] - step(u1 - shift * n)[0]) @ n / (2.0 * shift)
    assert n @ S @ n == pytest.approx(2.0 * slope, rel=1e-5, abs=1.0)  # the tangent is by the middle


def test_the_factors_scale_spring_and_damper_and_leave_the_stops():
    stops = EndStops(0.3, 8e4, 0.5, 5e4)
    for length, rate in ((0.2, -0.4), (0.38, 0.2), (0.6, 1.0)):
        at = along(length, rate)
        one, bare = element(SPRING, DAMPER, stops=stops)(*at), element(0.0, 0.0, stops=stops)(*at)
        spring, damper = element(SPRING)(*at), element(0.0, DAMPER)(*at)
        both = element(SPRING, DAMPER, stops=stops, stiffness_factor=1.7, damping_factor=0.4)(*at)
        parts = 1.7 * spring.out["force"] + 0.4 * damper.out["force"] + bare.out["force"]
        assert both.out["force"] == pytest.approx(parts, rel=1e-12)
        assert both.potential == pytest.approx(1.7 * spring.potential + bare.potential, rel=1e-12)
        again = element(SPRING, DAMPER, stops=stops, stiffness_factor=1.0, damping_factor=1.0)(*at)
        assert np.array_equal(again.f, one.f)


def oscillator(damper: object = 0.0) -> Model:
    m = Model("washboard", dimension=2, gravity=(0.0, -9.81))
    bob = m.point_mass("bob", mass=30.0, position=(0.0, -0.45))
    gap = m.ground.point((0.0, 0.0)) - bob.point((0.0, -0.45))
    m.add(SpringDamperTable(SPRING, damper, FREE).record("spring", gap))  # type: ignore[arg-type]
    m.initial_velocity(bob, (0.6, 2.0))
    m.sense_energy("energy")
    m.sense_position("y", bob, component="y")
    return m


SPEED = 1.5  # m/s
BARRIER = [(0.1, 0.0), (1.2, 0.0), (1.503, 0.0), (1.507, 280.0), (1.511, 0.0), (2.0, 0.0), (9.0, 0.0)]
"""Rows of a table, m and N."""


def slide(rows: object, speed: float = SPEED, gravity: float = 0.0, dimension: int = 2) -> System:
    """2 kg on a line, on a spring from 1 m behind the start; gravity is along the line. In space beside a road."""
    rest = (0.0,) * (dimension - 1)
    m = Model("slide", dimension=dimension, gravity=(gravity, *rest))
    body = m.body("body", mass=2.0, com=(1.0, *rest), inertia=0.1 if dimension == 2 else (0.1, 0.1, 0.1))
    m.prismatic("guide", m.ground, body, axis=(1.0, *rest))
    m.initial_velocity(body, linear=(speed, *rest), angular=0.0 if dimension == 2 else (0.0, 0.0, 0.0))
    stretch = body.point((1.0, *rest)) - m.ground.point((0.0, *rest))
    m.add(SpringDamperTable(rows).record("spring", stretch))  # type: ignore[arg-type]
    m.force("push", body, inputs=[m.input("push", min=-1.0, max=1.0), *[None] * (dimension - 1)])
    m.sense_position("x", body, component="x")
    if dimension == 3:
        m.road(PlaneRoad())
    return compile(m)


@pytest.mark.parametrize(
    "method", ["ali3p", "ali3p_generalised_alpha", "energy_momentum", "radau_5", "runge_kutta_8", "semi_recursive_4"]
)
@pytest.mark.parametrize("energy", [0.5, 2.0])
def test_a_barrier_that_lies_between_the_ends_of_a_step_is_met(method, energy):
    """8 mm wide, in steps of 15 mm; of so much of the energy of the motion: it is passed, or throws the body back."""
    peak = energy * SPEED**2 / 0.004
    system = slide([(x, force and peak) for x, force in BARRIER])
    exit_speed = SPEED * np.sqrt(1.0 - energy) if energy < 1.0 else -SPEED

    def error(run: Trajectory) -> float:
        return abs(float(run["x"][-1] - run["x"][-2]) / 0.01 / exit_speed - 1.0)

    assert error(simulate(system, 0.6, 0.01, method=method, tolerance=1e-2, progress=False)) < 0.01
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run = simulate(system, 0.6, 0.01, method=method, progress=False)
    assert run.report is not None
    assert run.report.divisions >= 2
    assert run.report.abrupt_steps >= 2
    assert error(run) < 0.1 or any(w.category is AccuracyWarning for w in caught)


@pytest.mark.parametrize("method", METHOD_TABLE)
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_barrier_that_a_step_from_rest_passes_by_its_acceleration_is_met(method, dimension):
    """It takes a quarter of the energy up to its middle; without it the body is 6 mm further at the end."""
    h, gravity = 0.02, 10.0  # 2 mm in the first step
    begin, middle, end = 1.0004, 1.0006, 1.0008
    peak = gravity * (middle - 1.0) / (middle - begin)
    rows = [(0.1, 0.0), (0.9, 0.0), (begin, 0.0), (middle, peak), (end, 0.0), (3.0, 0.0), (9.0, 0.0)]
    run, fine = (
        simulate(system, 0.2, step, method=method, every=round(h / step), estimate_error=False, progress=False)
        for system in [slide(rows, 0.0, gravity, dimension)]
        for step in (h, 2e-5)
    )
    assert run.report is not None
    assert run.report.divisions >= 2
    assert run.report.abrupt_steps >= 1
    assert np.abs(run["x"] - fine["x"]).max() < 5e-4


@pytest.mark.parametrize(("limit", "divisions"), [(0, 2), (4, 1), (10, 2)])
def test_parts_of_a_step_over_a_barrier_share_its_limit_of_iterations(limit, divisions):
    instance = Instance(LoadedSystem(slide(BARRIER).to_bytes()))
    instance.set_settings(step_iterations=limit)
    instance.initialise()
    iterations = [0]
    for _ in range(60):
        instance.run(0.01, 1)
        iterations.append(instance.report()["iterations"])
    assert (np.diff(iterations).max() <= limit) == (limit > 0)
    assert instance.report()["divisions"] == divisions


def test_a_jump_of_an_input_in_the_same_step_is_no_row_of_the_table():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        run = simulate(
            slide(BARRIER), 0.6, 0.01, {"push": ([0.0, 0.331, 0.331, 1.0], [0.0, 0.0, 1e-3, 1e-3])}, progress=False
        )
    assert run.report is not None
    assert (run.report.divisions, run.report.abrupt_steps) == (3, 2)


def test_a_bent_table_that_its_ends_tell_divides_no_step():
    """Steps over six of its rows."""
    x = np.linspace(-0.3, 0.3, 121)
    run = simulate(slide(np.c_[1.0 + x, 30.0 * (x + 40.0 * x**3)]), 2.0, 0.02, progress=False)
    assert np.ptp(run["x"]) > 0.4
    assert run.report is not None
    assert run.report.divisions == run.report.abrupt_steps == run.report.halvings == 0


def test_energy_is_kept_by_the_energy_momentum_method():
    m = oscillator()
    run = simulate(compile(m), 2.0, 0.001, settings=Settings(method="energy_momentum"))
    assert np.ptp(run["y"]) > 0.1
    assert np.ptp(run["energy"]) < 1e-7 * np.max(np.abs(run["energy"]))


def test_a_spring_by_table_declares_whether_it_dissipates_energy():
    assert element(SPRING).conservative
    assert element(SPRING, DAMPER).conservative is False
    assert element(SPRING, DAMPER, damping_factor=0.0).conservative
    assert element(SPRING, 10.0).conservative is False
    assert element(SPRING, stops=EndStops(0.3, 8e4, bump_loss=0.1)).conservative is False


@pytest.mark.parametrize("power", range(1, 6))
def test_slopes_of_a_damper_that_is_flat_at_an_end_are_not_below_nought(power):
    rng = np.random.default_rng(power)
    for _ in range(40):
        rates = np.sort(rng.uniform(-2.0, 2.0, 8))
        forces = np.cumsum(rng.choice([0.0, 1.0], 8) * 10.0**power * rng.uniform(size=8))
        rows = np.c_[rates - rates[3], forces - forces[3]]
        element(0.0, rows)  # the kernel checks it too


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"spring": [(0.0, 0.0)]}, "The table of the spring of the spring-damper 'strut' has 1 rows; it needs two"),
        ({"spring": [(0.0, 0.0), (0.0, 1.0)]}, "goes from 0 to 0 in its first column; it must rise"),
        ({"spring": [(0.0, 0.0), (-0.1, 1.0)]}, "goes from 0 to -0.1 in its first column"),
        ({"spring": -5.0}, "stiffness of the spring-damper 'strut' is -5"),
        ({"spring": [(0.0, 0.0, 1.0), (1.0, 1.0, 1.0)]}, "the table of the spring of the spring-damper 'strut'"),
        ({"damper": [(-1.0, 5.0), (0.0, 0.0)]}, "falls from 5 N at -1 m/s to 0 N at 0 m/s; it must not fall"),
        ({"damper": [(-1.0, -5.0), (1.0, 5.0)]}, "has no row (0, 0); a damper has no force at rest"),
        ({"stops": EndStops(0.9, 1.0, 0.8, 1.0)}, "must be less than the rebound length"),
    ],
)
def test_bad_tables_are_refused_with_a_sentence(change, sentence):
    with pytest.raises(ValueError, match="(?i)" + re.escape(sentence)):
        replace(SpringDamperTable(SPRING, DAMPER, FREE), **change).record("strut", vectors(3)[0])  # type: ignore[arg-type]


HEAD = 5 + 12  # reals before the tables


@pytest.mark.parametrize(
    ("place", "value", "message"),
    [
        (HEAD, 0.0, "must rise"),
        (HEAD + 3 * len(SPRING), 1e6, "energies"),
        (HEAD + 4 * len(SPRING) + len(DAMPER), 9e9, "must not fall"),
        (HEAD + 4 * len(SPRING) + len(DAMPER) + 3, 1.0, "origin"),
        (HEAD + 4 * len(SPRING) + 2 * len(DAMPER), -1.0, "must not fall"),
    ],
)
def test_the_kernel_checks_tables(place, value, message):
    assert message in (element(SPRING, DAMPER).with_reals({place: value}).check() or "")


def test_the_kernel_checks_the_energies_from_stretch_nought_and_the_count():
    bench = element(SPRING)
    real = np.array(bench.element.real)
    real[HEAD + 3 * len(SPRING) :] += 5.0
    record = bench.element
    bench.element = replace(record, real=list(real))
    assert "energies" in (bench.check() or "")
    for points in ((len(SPRING) - 1, 0), (1, 0), (-2, 0), (len(SPRING), 2)):
        bench.element = replace(record, integer=points)
        assert bench.check() is not None
