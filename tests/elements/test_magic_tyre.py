"""The tyre by the Magic Formula: its forces against a second implementation, tangent, energy, standstill."""

from dataclasses import replace
from functools import cache
from math import atan, cos, sin, sqrt, tan
from pathlib import Path

import numpy as np
import pytest

from mbs.elements import MagicTyre, PlaneRoad
from mbs.tyre_files import TyreFile, read_tyre
from tests.elements.harness import Element, Result, tangent_by_differences, vectors
from tests.elements.magic_formula import Coefficients, Forces, Operation, mf6, pac2002

DATA = Path(__file__).parents[1] / "tyre_files" / "data"
OWN = [DATA / f"assumed_{version}.tir" for version in (52, 61, 62)]
FILES = [*OWN, *sorted(DATA.glob("chrono/*.tir"))]
ids = [file.stem for file in FILES]
EXACT = 1e-6  # of the nominal load


@cache
def tyre_file(file: Path) -> TyreFile:
    return read_tyre(file)


def element_of(tyre: MagicTyre, friction: float = 1.0) -> Element:
    centre, axis, spin = vectors(3, 3, 1)
    return Element(tyre.record("tyre", centre, axis, spin[0], 0), PlaneRoad(friction=friction))


def grown(t: MagicTyre, omega: float) -> tuple[float, float]:
    """Free radius and factor of the vertical stiffness at a spin."""
    c = Coefficients(t.coefficients, t.radius, t.nominal_load)
    v = abs(omega) * t.radius / c.LONGVL
    return t.radius * (c.Q_RE0 + c.Q_V1 * v**2), (1.0 + c.Q_V2 * v) * (1.0 + c.PFZ1 * t.pressure)


def rolling_radius(t: MagicTyre, omega: float, deflection: float) -> float:
    c = Coefficients(t.coefficients, t.radius, t.nominal_load)
    radius, harder = grown(t, omega)
    load = harder * (t.stiffness + t.progression * deflection) * deflection / t.nominal_load
    nominal = (1.0 + c.PFZ1 * t.pressure) * sqrt(t.stiffness**2 + 4.0 * t.progression * t.nominal_load)
    return radius - t.nominal_load / nominal * (c.DREFF * atan(c.BREFF * load) + c.FREFF * load)


def pressed(t: MagicTyre, load: float, omega: float) -> float:
    """Deflection under a load."""
    _, harder = grown(t, omega)
    k, k2 = t.stiffness * harder, t.progression * harder
    return load / k if k2 == 0.0 else (sqrt(k**2 + 4.0 * k2 * load) - k) / (2.0 * k2)


def pose(t: MagicTyre, load: float, kappa: float, alpha: float, gamma: float, speed: float, direction: float = 1.0):
    """Signals and their rates of a wheel that leans to the right by gamma and rolls ahead, backwards with -1."""
    omega = (1.0 + kappa) * speed / t.radius
    for _ in range(60):
        deflection = pressed(t, load * cos(gamma), omega)
        omega = (1.0 + kappa) * speed / rolling_radius(t, omega, deflection)
    height = (grown(t, omega)[0] - deflection) * cos(gamma)
    u = np.array([0.0, 0.0, height, 0.0, cos(gamma), sin(gamma), 0.0])
    return u, np.array([direction * speed, speed * tan(alpha), 0.0, 0.0, 0.0, 0.0, direction * omega])


def settled(element: Element, u: np.ndarray, ud: np.ndarray) -> Result:
    y = np.zeros(4)
    for _ in range(400):
        r = element(u, ud, y, 10.0)
        if np.allclose(r.y, y, rtol=1e-13, atol=1e-16):
            break
        y = r.y
    return r


def book(t: MagicTyre, load: float, kappa: float, alpha: float, gamma: float, speed: float, mu: float) -> Forces:
    law = pac2002 if t.version in ("PAC2002", "MF52") else mf6
    state = Operation(load, kappa, alpha, gamma, speed, t.pressure, mu)
    return law(Coefficients(t.coefficients, t.radius, t.nominal_load), state, t.combination)


def kernel(element: Element, u: np.ndarray, ud: np.ndarray) -> tuple[Forces, float]:
    out = settled(element, u, ud).out
    forces = Forces(
        out["longitudinal_force"],
        out["lateral_force"],
        out["overturning_moment"],
        -out["resistance_moment"],
        out["aligning_moment"],
    )
    return forces, out["vertical_force"]


@pytest.mark.parametrize("file", FILES, ids=ids)
def test_forces_are_those_of_the_published_equations(file: Path) -> None:
    """Over slip, slip angle, camber, load up to four times the nominal one, pressure, friction and speed."""
    rng = np.random.default_rng(7)
    f, worst, rows = tyre_file(file), 0.0, []
    for k in range(80):
        more = {"pressure": f.nominal_pressure * rng.uniform(0.8, 1.3)} if f.nominal_pressure > 0.0 else {}
        t = f.tyre(**more)
        mu = float(rng.choice([0.4, 1.0, 1.2]))
        slips, angles, cambers = (min(-low, high) for low, high in (t.slip_range, t.angle_range, t.camber_range))
        kappa = float(rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-4.0, 0.0)) * min(slips, 1.0)
        alpha = float(rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-4.0, 0.0)) * min(angles, 1.2)
        gamma = rng.uniform(-cambers, cambers) * float(rng.choice([0.0, 1.0]))
        speed = float(rng.choice([2.0, 16.7, 60.0]))
        kappa = max(kappa, 1.0 / speed - 0.9) if kappa > -1.0 else kappa
        load = min(rng.uniform(0.05, 4.0) * t.nominal_load, t.largest_load)
        if k % 2:  # one slip alone
            kappa, alpha = (kappa, 1e-9) if k % 4 == 1 else (1e-9, alpha)
        u, ud = pose(t, load, kappa, alpha, gamma, speed)
        got, carried = kernel(element_of(t, mu), u, ud)
        assert carried == pytest.approx(load, rel=1e-9)
        expected = book(t, load, kappa, alpha, gamma, speed, mu)
        expected = replace(expected, My=max(expected.My, 0.0) * np.tanh(ud[6]))  # a negative resistance would drive
        for name, arm in (("Fx", 1.0), ("Fy", 1.0), ("Mx", t.radius), ("My", t.radius), ("Mz", t.radius)):
            error = abs(getattr(got, name) - getattr(expected, name)) / (t.nominal_load * arm)
            worst = max(worst, error)
            if not error < EXACT:
                rows.append((name, load, kappa, alpha, gamma, speed, mu, getattr(got, name), getattr(expected, name)))
    assert not rows, (len(rows), rows[:5])
    assert worst > 0.0


@pytest.mark.parametrize("file", FILES, ids=ids)
def test_a_tyre_on_the_other_side_is_its_mirror_image(file: Path) -> None:
    f, alpha = tyre_file(file), 0.04
    own, other = element_of(f.tyre(f.side)), element_of(f.tyre({"left": "right", "right": "left"}[f.side]))
    load, kappa, gamma = f.tyre().nominal_load, 0.02, 0.05
    a, b = (kernel(e, *pose(f.tyre(), load, kappa, s * alpha, s * gamma, 20.0))[0] for e, s in ((own, 1), (other, -1)))
    assert (b.Fx, -b.Fy, -b.Mx, b.My, -b.Mz) == pytest.approx((a.Fx, a.Fy, a.Mx, a.My, a.Mz), rel=1e-12, abs=1e-9)
    same = kernel(other, *pose(f.tyre(), load, kappa, alpha, gamma, 20.0))[0]
    assert abs(same.Fy - a.Fy) > 1e-3 * load  # the tyre is not symmetric


@pytest.mark.parametrize("signs", ["sae", "adapted_sae"])
def test_coefficients_of_other_axes_give_the_same_tyre(signs: str) -> None:
    """y to the right and z down: the lateral force, its moments, and for SAE the slip angle have the other sign."""
    f = tyre_file(OWN[1])
    c = dict(f.values["coefficients"])
    sides = "PVY1 PVY2 PVY3 PVY4 PKY6 PKY7 RVY1 RVY2 RVY3 QDZ6 QDZ7 QDZ8 QDZ9 QDZ10 QDZ11 SSZ1 SSZ3 SSZ4 QSX3 QSX8"
    even = "PHY1 PHY2 PEY3 PEY4 RBY3 RHX1 QHZ1 QHZ2 QHZ3 QHZ4 QEZ4 QEZ5"  # in the slip angle
    turned = [*sides.split(), "QSX13", "QSX14", *(even.split() if signs == "sae" else ("PKY1", "QBZ10"))]
    c |= {key: -c.get(key, 0.0) for key in turned}
    c = {key: value for key, value in c.items() if value != 0.0}
    other = replace(f, values={**f.values, "coefficients": c})
    for alpha, gamma in ((0.03, 0.04), (-0.05, 0.1)):
        u, ud = pose(f.tyre(), 3500.0, 0.03, alpha, gamma, 20.0)
        a, b = kernel(element_of(f.tyre()), u, ud)[0], kernel(element_of(other.tyre(signs=signs)), u, ud)[0]
        assert (b.Fx, b.Fy, b.My) == pytest.approx((a.Fx, a.Fy, a.My), rel=1e-10)
        assert (b.Mx, b.Mz) == pytest.approx((a.Mx, a.Mz), rel=1e-9)


def test_a_top_that_leans_to_the_right_thrusts_to_the_right() -> None:
    """Camber thrust of each file: towards the side to which the wheel leans, and none at rest."""
    for file in (*OWN, DATA / "chrono" / "mf_185_80R14.tir", DATA / "chrono" / "Sedan_Pac02Tire.tir"):
        t = tyre_file(file).tyre()
        element = element_of(t)
        left, right = (kernel(element, *pose(t, t.nominal_load, 0.0, 0.0, g, 20.0))[0].Fy for g in (-0.05, 0.05))
        assert right < left - 1e-3 * t.nominal_load, file.stem
        u, ud = pose(t, t.nominal_load, 0.0, 0.0, 0.05, 20.0)
        standing = settled(element, u, 0.0 * ud).out
        names = ("longitudinal_force", "lateral_force", "aligning_moment", "overturning_moment", "resistance_moment")
        assert all(abs(standing[name]) < 1e-6 for name in names)


@pytest.mark.parametrize("file", FILES, ids=ids)
def test_the_relaxation_length_is_that_of_the_file(file: Path) -> None:
    """A step of the slip angle of a rolling wheel: the lateral force lacks 1/e after the relaxation length."""
    f = tyre_file(file)
    t = replace(f.tyre(), settling=1e-9)
    c = Coefficients(t.coefficients, t.radius, t.nominal_load)
    load, speed = min(1.3 * t.nominal_load, t.largest_load), 10.0
    element = element_of(t)
    u, start = pose(t, load, 0.0, 0.0, 0.0, speed)
    u, ud = pose(t, load, 0.0, 1e-4, 0.0, speed)
    y, end = settled(element, u, start).y, settled(element, u, ud)
    first, last = settled(element, u, start).out["lateral_force"], end.out["lateral_force"]
    assert last < first
    Fz0 = c.Fz0 * c.LFZO
    dfz = load / Fz0 - 1.0
    if c.LATERAL_STIFFNESS:  # Besselink et al.: slip stiffness over the stiffness of the carcass
        carcass = c.LATERAL_STIFFNESS * (1 + c.PCFY1 * dfz + c.PCFY2 * dfz**2) * (1 + c.PCFY3 * t.pressure)
        sigma = (first - last) / 1e-4 / carcass
    elif c.PTY1:
        sigma = c.PTY1 * sin(2.0 * atan(load / (c.PTY2 * Fz0))) * c.R0 * c.LFZO * c.LSGAL
    else:
        sigma = c.R0 * load / Fz0
    h, shares = 1e-3 * sigma / speed, []
    for _ in range(1000):
        r = element(u, ud, y, h)
        y = r.y
        shares.append((r.out["lateral_force"] - last) / (first - last))
    assert shares[-1] == pytest.approx(np.exp(-1.0), rel=2e-2 if t.combination == "ellipse" else 2e-3)
    assert np.all(np.diff(shares) < 0.0)


def pushes(rng: np.random.Generator, t: MagicTyre) -> tuple[np.ndarray, np.ndarray]:
    speed = float(rng.choice([0.0, 1e-3, 1.0, 20.0]))
    v = 10.0 ** rng.uniform(-6.0, 1.0) * rng.normal(size=2)
    spin = (speed + rng.normal() * float(rng.choice([0.0, 1.0]))) / t.radius
    load = rng.uniform(0.05, 3.0) * t.nominal_load
    return np.r_[0.0, 0.0, t.radius - pressed(t, load, spin), 0.0, 1.0, 0.0, 0.0], np.r_[
        speed + v[0], v[1], np.zeros(4), spin
    ]


@pytest.mark.parametrize(("file", "h"), [(OWN[0], 0.002), (OWN[1], 0.1), (FILES[-1], 0.1)])
def test_sliding_only_takes_energy_where_there_are_no_shifts(file: Path, h: float) -> None:
    """Force times slip velocity plus deflection rate, by directions, limited or not, at rest and at speed."""
    t = tyre_file(file).tyre()
    shifts = ("PHX1", "PHX2", "PVX1", "PVX2", "PHY1", "PHY2", "PVY1", "PVY2", "RVY1", "RVY2", "RVY3")
    c = {**t.coefficients, **dict.fromkeys(shifts, 0.0)}
    c |= {key: min(c.get(key, 0.0), 1.0) for key in ("RCX1", "RCY1")}  # above 1 a weight turns round at large slips
    t = replace(t, coefficients=c)
    element, rng = element_of(t), np.random.default_rng(13)
    moved = 0.0
    for _ in range(200):
        u, ud = pushes(rng, t)
        y = np.r_[0.01 * rng.normal(size=2), 0.1 * rng.normal(size=2)]
        r = element(u, ud, y, h)
        F = np.array([r.out["longitudinal_force"], r.out["lateral_force"]])
        radius = rolling_radius(t, ud[6], pressed(t, r.out["vertical_force"], ud[6]))
        loaded = r.out["loaded_radius"]
        x = min((radius * ud[6]) ** 2, 1.0)
        slip = np.array([ud[0] - (loaded + x * (2.0 - x) * (radius - loaded)) * ud[6], ud[1]])
        power = F * (slip + r.y[2:])
        assert np.all(power <= 1e-6 * np.abs(F) * (np.abs(slip) + np.abs(r.y[2:]) + 1e-9)), (ud, power)
        moved = min(moved, power.min())
        assert np.all(np.isfinite(r.f))
    assert moved < -1.0


@pytest.mark.parametrize("file", OWN, ids=ids[:3])
def test_tangent_is_the_derivative_made_symmetric_and_safe(file: Path) -> None:
    """By the lateral velocity and the spin only the slip changes; their tangent, where the whole one is definite."""
    t = replace(tyre_file(file).tyre())
    t = replace(t, coefficients={**t.coefficients, "QSY1": 0.0, "QSY2": 0.0, "LMUV": 0.0, "Q_V1": 0.0, "Q_V2": 0.0})
    element, h, exact = element_of(t), 0.005, 0
    for kappa in (-0.05, -0.01, 0.0, 0.02):
        for alpha in (-0.04, 0.0, 0.01):
            u, ud = pose(t, 1.2 * t.nominal_load, kappa, alpha, 0.03, 20.0)
            y = settled(element, u, ud).y
            S = element(u, ud, y, h, 1.0, 0.0).S
            assert np.linalg.eigvalsh(S)[0] > -1e-9 * np.max(S)
            expected = tangent_by_differences(element, u, ud, y, h, 1.0, 0.0, (), step=1e-5)
            assert S[1, 1] >= expected[1, 1] * (1.0 - 1e-4)
            if abs(kappa) < 0.02 and abs(alpha) < 0.02:
                exact += 1
                pairs = [(S[i, j], expected[i, j]) for i, j in ((1, 1), (6, 6))]
                assert all(s == pytest.approx(w, rel=0.02) for s, w in pairs), pairs
    assert exact >= 2


def test_tangent_at_rest_is_that_of_the_carcass() -> None:
    t = tyre_file(OWN[0]).tyre()
    element, h = element_of(t), 0.005
    u = np.r_[0.0, 0.0, t.radius - pressed(t, t.nominal_load, 0.0), 0.0, 1.0, 0.0, 0.0]
    r = element(u, np.zeros(7), None, h, 0.5 * h, 0.0)
    expected = tangent_by_differences(element, u, np.zeros(7), None, h, 0.5 * h, 0.0, (), step=1e-8)
    assert np.max(np.abs(r.S - expected)[:2, :2]) < 2e-3 * np.max(np.abs(expected[:2, :2]))


def test_in_the_air_it_has_no_force_and_its_deflection_dies_out() -> None:
    t = tyre_file(OWN[0]).tyre()
    element, y = element_of(t), np.r_[0.01, -0.02, 0.0, 0.0]
    u, ud = np.r_[0.0, 0.0, 1.5 * t.radius, 0.0, 1.0, 0.0, 0.0], np.r_[30.0, 1.0, np.zeros(4), 50.0]
    for _ in range(60):
        r = element(u, ud, y, 0.01)
        assert np.array_equal(r.f, np.zeros(7))
        y = r.y
    assert np.max(np.abs(y)) < 1e-6


def test_a_standing_tyre_is_a_spring_that_slides_at_its_friction() -> None:
    t = tyre_file(OWN[0]).tyre()
    element = element_of(t, 0.7)
    u, y, h = np.r_[0.0, 0.0, t.radius - pressed(t, t.nominal_load, 0.0), 0.0, 1.0, 0.0, 0.0], np.zeros(4), 0.005
    forces = []
    for _ in range(2000):  # 2 cm/s sideways
        r = element(u, np.r_[0.0, 0.02, np.zeros(5)], y, h)
        y = r.y
        forces.append(r.out["lateral_force"])
    stiffness = -(forces[8] - forces[4]) / (4 * h * 0.02)
    assert stiffness == pytest.approx(r.potential and 2.0 * (r.potential - _spring(t)) / y[1] ** 2, rel=0.05)
    assert abs(forces[-1]) < 0.7 * 1.2 * t.nominal_load
    assert abs(forces[-1] - forces[-2]) < 1e-6 * t.nominal_load


def _spring(t: MagicTyre) -> float:
    d = pressed(t, t.nominal_load, 0.0)
    _, harder = grown(t, 0.0)
    return harder * (0.5 * t.stiffness * d**2 + t.progression * d**3 / 3.0)


def test_forces_do_not_jump_where_the_wheel_stops_or_turns_back() -> None:
    t = tyre_file(OWN[1]).tyre()
    element = element_of(t)
    height = t.radius - pressed(t, t.nominal_load, 0.0)
    last = None
    for v in np.linspace(0.1, -0.1, 667):
        ud = np.r_[v, 0.001, np.zeros(4), v / t.radius]
        r = element(np.r_[0.0, 0.0, height, 0.0, 1.0, 0.0, 0.0], ud, np.r_[1e-4, 1e-4, 0.0, 0.0], 0.005)
        assert np.all(np.isfinite(r.f))
        if last is not None:
            assert np.max(np.abs(r.f - last)) < 0.02 * t.nominal_load
        last = r.f


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"radius": 0.1}, "bottoming radius"),
        ({"sign_force": 0.5}, "sign"),
        ({"slip_range_least": 0.1}, "contain zero"),
        ({"PCX1": 0.0}, "lacks shape"),
        ({"LKY": -1.0}, "LKX and LKY"),
    ],
)
def test_kernel_checks_the_data(change: dict[str, float], word: str) -> None:
    assert word in (element_of(tyre_file(OWN[1]).tyre()).with_reals(change).check() or "")


def test_bad_data_are_refused_with_a_sentence() -> None:
    t = tyre_file(OWN[1]).tyre()
    for change, word in (
        ({"version": "MF99"}, "version"),
        ({"combination": "sum"}, "combination"),
        ({"signs": "din"}, "signs"),
        ({"coefficients": {"PDX9": 1.0}}, "no coefficient PDX9"),
        ({"coefficients": {"LKX": 0.0}}, "LKX of the tyre 'tyre' is 0"),
        ({"bottoming_radius": 0.4}, "must be less than"),
    ):
        with pytest.raises(ValueError, match=word):
            element_of(replace(t, **change))  # type: ignore[arg-type]


@pytest.mark.parametrize("gamma", [0.0, 0.1])
def test_moments_act_on_the_wheel_about_normal_heading_and_axis(gamma: float) -> None:
    """By virtual rotations: moments of the forces at the patch, with the rolling radius as lever, and Mx, My, Mz."""
    t = tyre_file(OWN[1]).tyre()
    u, ud = pose(t, t.nominal_load, 0.03, 0.05, gamma, 20.0)
    r = settled(element_of(t), u, ud)
    forward, leftward, up = np.eye(3)
    axis, out = u[3:6], r.out
    force = out["longitudinal_force"] * forward + out["lateral_force"] * leftward + out["vertical_force"] * up
    rho = np.array([out[f"contact_{k}"] for k in "xyz"]) - u[:3]
    longer = rolling_radius(t, ud[6], out["deflection"]) / out["loaded_radius"]
    lever = np.cross(rho, force) + (longer - 1.0) * (np.cross(rho, force) @ axis) * axis
    moment = lever + out["overturning_moment"] * forward + out["aligning_moment"] * up + out["resistance_moment"] * axis
    assert abs(out["aligning_moment"]) > 10.0
    assert abs(out["overturning_moment"]) > 1.0
    assert out["resistance_moment"] < -5.0
    for turn in np.eye(3):
        virtual = np.r_[0.0, 0.0, 0.0, np.cross(turn, axis), turn @ axis]
        assert r.f @ virtual == pytest.approx(moment @ turn, abs=1e-6 * t.nominal_load)
