"""The tyre in motion: relaxation, order of convergence, standstill, friction bound, flight."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from mbs.elements import Brake, InputForce, KerbRoad, Road
from tests.elements import tmeasy
from tests.elements.harness import Array, Element, signals, vectors
from tests.elements.stepper import Part, Stepper
from tests.elements.tyre_data import TYRE, tyre_element, upright

MASS = 130.0  # kg
INERTIA = 0.55  # kg m2
G = 9.81  # m/s2
R = TYRE.radius
CREEP = 2e-5  # m in 20 s on a ten per cent slope


def rolling_rate(speed: float, load: float = MASS * G) -> float:
    """Spin without slip."""
    loaded = R - load / TYRE.stiffness
    rolling = (2.0 * R + loaded) / 3.0
    omega = speed / rolling
    for _ in range(50):
        x = min((rolling * omega) ** 2, 1.0)
        share = x * (2.0 - x)
        omega = speed / (loaded + share * (rolling - loaded))
    return omega


class Corner:
    """A quarter of a car on one wheel: coordinates x, y, z of the centre and the spin chi; the axis stays along y."""

    TYRE_SIGNALS = np.zeros((7, 4))
    TYRE_SIGNALS[[0, 1, 2, 6], [0, 1, 2, 3]] = 1.0
    BRAKE_SIGNALS = np.zeros((7, 4))
    BRAKE_SIGNALS[6, 3] = 1.0

    def __init__(
        self,
        speed: float = 0.0,
        height: float | None = None,
        grade: tuple[float, float] = (0.0, 0.0),
        pedal: Callable[[float], float] | None = None,
        push: Callable[[float], tuple[float, float]] | None = None,
        road: Road | None = None,
        tyre: object = TYRE,
    ) -> None:
        element = tyre_element(tyre, road)  # type: ignore[arg-type]
        parts = [Part(element, self.TYRE_SIGNALS, upright(0.0))]
        if pedal is not None:
            f, g, spin = vectors(3, 3, 1)
            stiffness = 650.0 * R / 0.9e-3
            law = Brake(650.0, stiffness, 2.0 * np.sqrt(stiffness * INERTIA))
            brake = Element(law.record("brake", f, g, spin[0], 0))
            parts.append(
                Part(brake, self.BRAKE_SIGNALS, np.r_[0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0], lambda t: (pedal(t),))
            )
        if push is not None:
            force = Element(InputForce(0, (1.0,)).record("push", signals(1)))
            for k, coordinate in enumerate((1, 3)):
                B = np.zeros((1, 4))
                B[0, coordinate] = 1.0
                parts.append(Part(force, B, np.zeros(1), lambda t, k=k: (push(t)[k],)))  # type: ignore[misc]
        # gravity leans instead of the road: then standing still means constant coordinates
        load = MASS * G * np.array([-grade[0], -grade[1], -np.sqrt(1.0 - grade[0] ** 2 - grade[1] ** 2), 0.0])
        z = R + load[2] / TYRE.stiffness if height is None else height
        self.motion = Stepper(
            np.array([MASS, MASS, MASS, INERTIA]),
            load,
            parts,
            [0.0, 0.0, z, 0.0],
            [speed, 0.0, 0.0, rolling_rate(speed)],
        )

    @property
    def out(self) -> dict[str, float]:
        return self.motion.results[0].out

    @property
    def brake(self) -> dict[str, float]:
        return self.motion.results[1].out


@pytest.mark.parametrize("speed", [2.0, 20.0])
def test_side_force_builds_up_over_the_relaxation_length(speed: float) -> None:
    load, step = 1500.0, 1e-4
    element = tyre_element(replace(TYRE, carcass_damping=(500.0, 1.0)))
    omega = rolling_rate(speed, load)
    length = 23974.0 / 80000.0  # cornering stiffness over carcass stiffness
    slip = 1e-4
    u, ud = upright(R - load / TYRE.stiffness), np.array([speed, slip * speed, 0.0, 0.0, 0.0, 0.0, omega])
    y = np.zeros(4)
    for _ in range(round(length / speed / step)):
        r = element(u, ud, y, step)
        y = r.y
    assert r.out["lateral_force"] == pytest.approx(-(1.0 - np.exp(-1.0)) * 23974.0 * slip, rel=0.01)


@pytest.mark.slow
def test_rolling_wheel_converges_with_order_two() -> None:
    def course(h: float) -> Array:
        corner = Corner(10.0, push=lambda t: (800.0 * np.sin(6.0 * t) ** 2, 100.0 * np.sin(9.0 * t) ** 2))
        s, rows = corner.motion, []
        for _ in range(10):
            s.run(s.t + 0.02, h)
            rows.append(np.r_[s.q[:2], s.qd[[0, 1, 3]], s.y[0][:2]])
        return np.array(rows)

    steps = np.array([0.02, 0.01, 0.005, 0.0025])
    reference = course(0.0005)
    errors = np.array([np.max(np.abs(course(h) - reference), axis=0) for h in steps])
    orders = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert np.all(errors[-1] < 0.1 * errors[0])
    assert np.all(orders > 1.8)
    assert np.all(orders < 2.3)


def test_standing_tyre_gives_no_energy_in_closed_cycles() -> None:
    """Wheel centre and spin are led around loops; what goes in must not be negative."""
    h = 0.01
    element = tyre_element(replace(TYRE, trail=(0.0, 0.0)))
    rng = np.random.default_rng(11)
    rows = []
    for size in (1e-4, 3e-3, 3e-2):
        for _ in range(4):
            phase, amplitude = rng.uniform(0.0, 6.0, size=3), size * rng.uniform(0.3, 1.0, size=3) * [1.0, 1.0, 4.0]
            y, work, peak = np.zeros(4), 0.0, 0.0
            count = round(2.0 / h)
            last = None
            for i in range(count + 1):
                t = 2.0 * np.pi * i / count
                x = amplitude * (np.sin(3.0 * t + phase) - np.sin(phase))
                v = amplitude * np.cos(3.0 * t + phase) * 3.0 * 2.0 * np.pi / (count * h)
                u = upright(0.25) + np.r_[x[:2], 0.0, 0.0, 0.0, 0.0, x[2]]
                r = element(u, np.r_[v[:2], 0.0, 0.0, 0.0, 0.0, v[2]], y, h)
                y = r.y
                power = -(r.f @ np.r_[v[:2], 0.0, 0.0, 0.0, 0.0, v[2]])
                if last is not None:
                    work += 0.5 * h * (power + last)
                last = power
                peak = max(peak, r.potential - 0.5 * TYRE.stiffness * 0.02**2)
            rows.append((size, work + 1e-3 * peak, peak))
    assert all(work >= 0.0 for _, work, _ in rows)
    assert max(work / peak for size, work, peak in rows if size > 1e-2) > 1.0  # large loops slide and lose


@pytest.mark.slow
@pytest.mark.parametrize("h", [0.01])
def test_braked_wheel_stops_on_a_slope_and_stays(h: float) -> None:
    corner = Corner(8.0, grade=(0.1, 0.03), pedal=lambda t: min(1.0, max(0.0, (t - 0.2) / 0.2)))
    s = corner.motion
    energies = [s.energy]
    for _ in range(round(8.0 / h)):
        s.step(h)
        energies.append(s.energy)
    assert np.max(np.diff(energies)) < 1e-6 * energies[0]  # never gains
    rest = s.q.copy()
    s.run(s.t + 20.0, 2.0 * h)
    assert np.max(np.abs(s.q - rest)[:3]) < CREEP
    assert np.max(np.abs(s.qd)) < 1e-6
    assert corner.brake["sticking"] == 1.0
    assert corner.out["longitudinal_force"] == pytest.approx(MASS * G * 0.1, rel=1e-4)
    assert max(s.iterations) < 40  # to round-off, in the step where brake and tyre catch
    assert np.mean(s.iterations) < 4.0


def test_friction_bound_holds_in_violent_transients() -> None:
    rng = np.random.default_rng(12)
    element = tyre_element()
    worst, limited = 0.0, 0
    for _ in range(40):
        h = rng.choice([0.001, 0.005, 0.02])
        y = np.r_[0.02 * rng.normal(size=2), rng.normal(size=2)]
        for _ in range(30):
            load = rng.choice([0.0, 5.0, 500.0, 3000.0])
            u = upright(R - load / TYRE.stiffness)
            ud = np.r_[3.0 * rng.normal(size=2), 0.0, 0.0, 0.0, 0.0, 10.0 * rng.normal()]
            r = element(u, ud, y, h)
            y = r.y
            if load == 0.0:
                assert r.out["longitudinal_force"] == r.out["lateral_force"] == 0.0
                continue
            Fx, Fy = r.out["longitudinal_force"], r.out["lateral_force"]
            mu = TYRE.reference_friction
            alone = [tmeasy.direction(TYRE, name, load, mu) for name in ("longitudinal", "lateral")]
            use = np.hypot(Fx, Fy) / tmeasy.largest(*alone, np.arctan2(Fy, Fx))
            worst, limited = max(worst, use), limited + (use > 0.9999)
    assert worst < 1.0 + 1e-9
    assert limited > 20


@pytest.mark.parametrize("h", [0.01, 1.0])
def test_sliding_only_takes_energy(h: float) -> None:
    """Power of the force on slip velocity plus deflection rate is never positive, limited or not, for any step."""
    element = tyre_element()
    rng = np.random.default_rng(13)
    for _ in range(300):
        v = rng.normal(size=2) * 10.0 ** rng.uniform(-6, 1)
        y = np.r_[0.01 * rng.normal(size=2), 0.1 * rng.normal(size=2)]
        r = element(upright(0.25), np.r_[v, 0.0, 0.0, 0.0, 0.0, 0.0], y, h)
        F = np.array([r.out["longitudinal_force"], r.out["lateral_force"]])
        # component by component: each direction opposes its own sliding
        assert np.all(F * (v + r.y[2:]) <= 1e-9 * np.abs(F) * (np.abs(v) + np.abs(r.y[2:])))


def test_deflection_dies_out_in_the_air_and_force_returns_without_a_jump() -> None:
    element = tyre_element()
    y = np.r_[0.01, -0.02, 0.0, 0.0]
    for _ in range(10):
        r = element(upright(0.5), np.r_[5.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0], y, 0.01)
        assert np.array_equal(r.f, np.zeros(7))
        assert np.all(np.abs(r.y[:2]) <= 0.6 * np.abs(y[:2]))
        y = r.y
    assert np.max(np.abs(y[:2])) < 1e-6
    for _ in range(2000):
        y = element(upright(0.5), np.zeros(7), y, 0.01).y
    assert np.array_equal(y, np.zeros(4))
    forces = [
        element(upright(R - d), np.r_[5.0, 1.0, -1.0, 0.0, 0.0, 0.0, 10.0], np.r_[0.01, 0.01, 0.0, 0.0], 0.01).f
        for d in np.linspace(-1e-6, 1e-6, 21)
    ]
    assert np.max(np.abs(forces)) < 0.1


def test_stiff_carcass_does_not_ring() -> None:
    """With a carcass a thousand times too stiff the steady force comes at once and stays."""
    element = tyre_element(replace(TYRE, carcass_stiffness=(1.5e8, 8e7)))
    y, forces = np.zeros(4), []
    for _ in range(50):
        r = element(upright(0.245), np.r_[10.0, 0.5, 0.0, 0.0, 0.0, 0.0, rolling_rate(10.0, 1500.0)], y, 0.01)
        y = r.y
        forces.append(r.out["lateral_force"])
    assert np.all(np.diff(forces) <= 1e-9 * abs(forces[-1]))  # from above, no overshoot
    assert forces[3] == pytest.approx(forces[-1], rel=1e-3)


def test_evaluation_without_a_step_repeats_the_end_of_the_step() -> None:
    corner = Corner(10.0, push=lambda t: (600.0, 0.0))
    corner.motion.run(0.3, 0.01)
    s = corner.motion
    again = s.parts[0].element(s.parts[0].B @ s.q + s.parts[0].b, s.parts[0].B @ s.qd, s.y[0])
    assert np.allclose(again.f, s.results[0].f, rtol=1e-10)
    assert np.array_equal(again.y[:2], s.y[0][:2])
    assert np.allclose(again.y, s.y[0], rtol=1e-8)  # rates are those that follow from deflections and slip


def test_kerb_drop_needs_few_iterations() -> None:
    corner = Corner(5.0, height=0.08 + R - MASS * G / TYRE.stiffness, road=KerbRoad(0.5, 0.08, friction=0.8))
    s = corner.motion
    s.run(0.6, 0.01)
    assert s.q[0] > 2.5
    assert abs(s.q[2] - R) < 0.2
    assert max(s.iterations) < 15
    assert np.mean(s.iterations) < 4.5
