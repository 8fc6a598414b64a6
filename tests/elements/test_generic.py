"""Springs, input forces, gyroscopic moment and drag: closed forms, virtual work and tangents by differences."""

import re

import numpy as np
import pytest

from mbs.elements import (
    BodyForce,
    BodyTorque,
    Drag,
    EndStops,
    GyroscopicSpin,
    HubWrench,
    InputForce,
    Lift,
    ScalarSpringDamper,
    SpinAngle,
    SpinTorque,
    SpringDamper,
    SpringDamperTable,
    Wind,
    WindDrag,
)
from tests.elements.harness import Element, frame, signals, tangent_by_differences, vectors

DIFFERENCES = 2e-8  # relative error of central differences with step 1e-6
ROUND_OFF = 1e-12
INPUTS = (30.0, -20.0, 7.0)


def spring(dimension: int = 3, stops: EndStops | None = None) -> Element:
    (d,) = vectors(dimension)
    return Element(SpringDamper(12360.0, 1000.0, 0.75, stops).record("spring", d))


def elements() -> dict[str, Element]:
    p2, a2 = vectors(2, 2)
    p, a, b, c = vectors(3, 3, 3, 3)
    f, g, chi = vectors(3, 3, 1)
    stops = EndStops(0.9, 80000.0, 0.8, 50000.0)
    return {
        "spring in space": spring(),
        "spring in the plane": spring(2),
        "spring on both stops": Element(SpringDamper(100.0, 5.0, 0.4, EndStops(2.5, 300.0)).record("s", p)),
        "spring on its rebound stop": Element(
            SpringDamper(100.0, 5.0, 0.4, EndStops(0.1, 3.0, 0.2, 9.0)).record("s", p)
        ),
        "stops not overlapping": spring(3, EndStops(0.1, 80000.0, stops.rebound_length, 50000.0)),
        "scalar spring": Element(ScalarSpringDamper(30.0, 2.0, 0.3, 5.0).record("s", signals(1)[0])),
        "input force": Element(InputForce(1, (1.0, -2.0)).record("i", signals(2))),
        "body force in space": Element(BodyForce((0, 1, 2)).record("f", p, (a, b, c))),
        "body force along one axis": Element(BodyForce((None, 1, None)).record("f", p, (a, b, c))),
        "body force in the plane": Element(BodyForce((0, 2)).record("f", p2, (a2,))),
        "torque in earth axes": Element(BodyTorque((0, 1, 2)).record("t", vectors(3, 3, 3))),
        "torque in body axes": Element(BodyTorque((0, 1, 2), "body").record("t", vectors(3, 3, 3))),
        "torque in the plane": Element(BodyTorque((1,)).record("t", vectors(2))),
        "gyroscopic spin": Element(GyroscopicSpin(0.55).record("g", f, g, chi[0])),
        "spin angle": Element(SpinAngle().record("a", f, g, chi[0])),
        "spin torque": Element(SpinTorque(1, 1.5).record("t", f, g, chi[0])),
        "drag in space": Element(Drag(0.8).record("d", p)),
        "lift in space": Element(Lift(0.3).record("l", *vectors(3, 3, 3))),
        "drag in wind": Element(WindDrag(0.8, wind=Wind(0, 1)).record("d", p)),
        "lift in wind": Element(Lift(0.3).record("l", *vectors(3, 3, 3), Wind(0, 1))),
        "wrench on a hub": Element(HubWrench((0, 1, 2, 1, 2, 0)).record("w", f, g, chi[0])),
        "lift in the plane": Element(Lift(-3.0).record("l", *vectors(2, 2, 2))),
        "spring by table": Element(
            SpringDamperTable(
                ((-2.0, -300.0), (0.0, 10.0), (0.4, 50.0), (1.5, 400.0)),
                ((-1.0, -40.0), (0.0, 0.0), (0.3, 5.0), (2.0, 9.0)),
                0.4,
                EndStops(2.5, 300.0),
                1.2,
                0.7,
            ).record("s", p)
        ),
        "spring by table in the plane": Element(SpringDamperTable(30.0, ((-1.0, -4.0), (0.0, 0.0))).record("s", p2)),
        "drag in the plane": Element(Drag(0.8).record("d", p2)),
    }


@pytest.mark.parametrize("name", list(elements()))
@pytest.mark.parametrize("weights", [(0.005, 0.0), (0.0, 0.000025)])
def test_tangent_is_the_symmetric_part_of_the_derivative(name: str, weights: tuple[float, float]) -> None:
    element = elements()[name]
    rng = np.random.default_rng(1)
    for _ in range(5):
        n = len(element.element.signals)
        u, ud = rng.normal(size=n), rng.normal(size=n)
        r = element(u, ud, None, 0.01, *weights, INPUTS)
        expected = tangent_by_differences(element, u, ud, None, 0.01, *weights, INPUTS)
        scale = max(np.max(np.abs(r.f)), np.max(np.abs(r.S)), 1.0)
        assert np.max(np.abs(r.S - expected)) < DIFFERENCES * scale
        assert np.array_equal(r.S, r.S.T)


def test_spring_force_is_tension_positive_and_elastic_force_the_gradient_of_its_energy() -> None:
    element = spring(3, EndStops(0.60, 80000.0, 0.90, 50000.0))
    rng = np.random.default_rng(2)
    visited = set()
    for length in np.linspace(0.5, 1.0, 11):
        n = rng.normal(size=3)
        n /= np.linalg.norm(n)
        r = element(length * n, np.zeros(3))
        assert r.out["length"] == pytest.approx(length, abs=1e-12)
        expected = 12360.0 * (length - 0.75) + 80000.0 * min(0.0, length - 0.60) + 50000.0 * max(0.0, length - 0.90)
        assert r.out["force"] == pytest.approx(expected, abs=1e-8)
        visited.add(int(np.sign(length - 0.60) + np.sign(length - 0.90)))
        slope = [
            (
                element(length * n + 1e-6 * e, np.zeros(3)).potential
                - element(length * n - 1e-6 * e, np.zeros(3)).potential
            )
            / 2e-6
            for e in np.eye(3)
        ]
        assert np.allclose(r.f, -np.array(slope), atol=0.1)  # a stop's force has a kink, 5e4 N/m times 1e-6 m
    assert {-2, 0, 2} <= visited


def test_damper_takes_the_power_of_its_rate() -> None:
    rng = np.random.default_rng(3)
    d, v = rng.normal(size=3), rng.normal(size=3)
    r, rest = spring()(d, v), spring()(d, np.zeros(3))
    rate = d @ v / np.linalg.norm(d)
    assert r.out["rate"] == pytest.approx(rate, rel=1e-12)
    assert (r.f - rest.f) @ v == pytest.approx(-1000.0 * rate**2, rel=1e-10)


def test_spring_of_no_length_has_no_direction_and_no_force() -> None:
    r = spring()(np.zeros(3), np.array([1.0, 2.0, 3.0]), None, 0.01, 0.005, 0.000025)
    assert np.array_equal(r.f, np.zeros(3))
    assert np.all(np.linalg.eigvalsh(r.S) > 0.0)


def test_scalar_spring_has_a_preload_that_does_work() -> None:
    element = elements()["scalar spring"]
    r = element([0.5], [0.1])
    assert r.f[0] == pytest.approx(5.0 - 30.0 * 0.2 - 2.0 * 0.1, abs=ROUND_OFF)
    slope = (element([0.5 + 1e-6], [0.0]).potential - element([0.5 - 1e-6], [0.0]).potential) / 2e-6
    assert slope == pytest.approx(-element([0.5], [0.0]).f[0], rel=1e-6)


def test_forces_from_inputs_have_the_power_of_the_force() -> None:
    rng = np.random.default_rng(4)
    R, v = frame(rng), rng.normal(size=3)
    u = np.r_[rng.normal(size=3), R.T.ravel()]
    ud = np.r_[v, rng.normal(size=9)]
    f = elements()["body force in space"](u, ud, inputs=INPUTS).f
    assert f @ ud == pytest.approx((R @ INPUTS) @ v, rel=ROUND_OFF)
    angle = 0.7
    u2 = np.array([0.1, 0.2, np.cos(angle), np.sin(angle)])
    f2 = elements()["body force in the plane"](u2, np.zeros(4), inputs=INPUTS).f
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    assert np.allclose(f2, [*(turn @ [INPUTS[0], INPUTS[2]]), 0.0, 0.0], atol=1e-12)
    assert np.array_equal(elements()["input force"](np.zeros(2), np.zeros(2), inputs=INPUTS).f, [-20.0, 40.0])


@pytest.mark.parametrize("axes", ["earth", "body"])
def test_torque_has_the_power_of_the_torque(axes: str) -> None:
    element = elements()[f"torque in {axes} axes"]
    rng = np.random.default_rng(5)
    R, omega = frame(rng), rng.normal(size=3)
    ud = np.cross(omega, R.T).ravel()
    m = np.array(INPUTS) if axes == "earth" else R @ INPUTS
    f = element(R.T.ravel(), ud, inputs=INPUTS).f
    assert f @ ud == pytest.approx(m @ omega, rel=1e-11)
    stretch = R.T.ravel()  # lengthening the vectors breaks orthonormality: no part of the force does that
    assert f @ stretch == pytest.approx(0.0, abs=1e-12)


def test_planar_torque_has_the_power_of_the_torque() -> None:
    a = np.array([np.cos(0.4), np.sin(0.4)])
    rate = 3.0
    f = elements()["torque in the plane"](a, rate * np.array([-a[1], a[0]]), inputs=INPUTS).f
    assert f @ (rate * np.array([-a[1], a[0]])) == pytest.approx(INPUTS[1] * rate, rel=ROUND_OFF)


def test_gyroscopic_moment_is_minus_the_change_of_spin_momentum_and_does_no_work() -> None:
    element = elements()["gyroscopic spin"]
    rng = np.random.default_rng(6)
    R, omega, spin = frame(rng), rng.normal(size=3), 40.0
    f, g, axis = R[:, 0], R[:, 1], R[:, 2]
    ud = np.r_[np.cross(omega, f), np.cross(omega, g), spin]
    force = element(np.r_[f, g, 0.3], ud).f
    moment = -0.55 * spin * np.cross(omega, axis)
    for turn in np.eye(3):
        virtual = np.r_[np.cross(turn, f), np.cross(turn, g), 0.0]
        assert force @ virtual == pytest.approx(moment @ turn, abs=1e-11)
    assert force @ ud == pytest.approx(0.0, abs=1e-11)


def test_drag_opposes_the_speed_with_its_square() -> None:
    v = np.array([3.0, -4.0, 12.0])
    r = elements()["drag in space"](np.zeros(3), v)
    assert np.allclose(r.f, -0.5 * 1.225 * 0.8 * 13.0 * v, rtol=1e-14)
    assert r.out["force"] == pytest.approx(0.5 * 1.225 * 0.8 * 169.0)
    assert np.array_equal(
        elements()["drag in space"](np.zeros(3), np.zeros(3), None, 0.01, 0.005, 0.0).S, np.zeros((3, 3))
    )


def test_in_wind_the_velocity_over_the_air_counts() -> None:
    """Wind of 30 m/s along the heading -20 rad: the element moves over it at v - w."""
    w = 30.0 * np.array([np.cos(-20.0), np.sin(-20.0), 0.0])
    v, still = np.array([3.0, -4.0, 12.0]), elements()["drag in space"]
    drag = elements()["drag in wind"]
    assert np.allclose(drag(np.zeros(3), v, inputs=INPUTS).f, still(np.zeros(3), v - w).f, rtol=1e-12)
    assert np.allclose(drag(np.zeros(3), w, inputs=INPUTS).f, 0.0, atol=1e-12)
    u = np.r_[np.zeros(3), 0.6, 0.8, 0.0, 0.0, 0.0, 1.0]
    ud, relative = np.r_[v, np.zeros(6)], np.r_[v - w, np.zeros(6)]
    lift, calm = elements()["lift in wind"], elements()["lift in space"]
    assert np.allclose(lift(u, ud, inputs=INPUTS).f, calm(u, relative).f, rtol=1e-12)


def test_a_wrench_on_a_hub_has_the_power_of_force_and_moment() -> None:
    """The moment about the axis turns the wheel, the rest its carrier."""
    rng = np.random.default_rng(7)
    e, omega, v, spin = frame(rng)[:, 0], rng.normal(size=3), rng.normal(size=3), 40.0
    force, moment = np.array(INPUTS), np.array([INPUTS[1], INPUTS[2], INPUTS[0]])
    r = elements()["wrench on a hub"](np.r_[0.1, 0.2, 0.3, e, 0.7], np.r_[v, np.cross(omega, e), spin], inputs=INPUTS)
    wheel = omega - (omega @ e) * e + spin * e
    assert r.f @ np.r_[v, np.cross(omega, e), spin] == pytest.approx(force @ v + moment @ wheel, rel=1e-11)
    assert r.out["power"] == pytest.approx(force @ v + moment @ wheel, rel=1e-11)
    assert r.f[6] == pytest.approx(moment @ e)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: SpringDamper(1.0).record("strut", vectors(4)[0]), "has 4 components; it must have 2 or 3"),
        (
            lambda: SpringDamper(1.0, stops=EndStops(0.9, 1.0, 0.8, 1.0)).record("strut", vectors(3)[0]),
            "must be less than the rebound length",
        ),
        (
            lambda: InputForce(0, (1.0, 2.0)).record("Push", signals(1)),
            "The input force 'Push' has 2 weights for 1 signals",
        ),
        (lambda: BodyForce((0, 1)).record("push", vectors(3)[0], vectors(3, 3, 3)), "has 2 inputs; it needs 3"),
        (lambda: BodyForce((0, 1, 2)).record("push", vectors(3)[0], vectors(3)), "must be three vectors"),
        (lambda: BodyTorque((0,)).record("twist", vectors(3, 3, 3)), "has 1 inputs; it needs 3"),
        (lambda: BodyTorque((0, 1, 2), "moon").record("twist", vectors(3, 3, 3)), "must be 'earth' or 'body'"),  # type: ignore[arg-type]
        (lambda: WindDrag(0.8, wind=None).record("air", vectors(3)[0]), "The wind of the drag 'air' must be a Wind"),  # type: ignore[arg-type]
        (lambda: WindDrag(0.8, wind=Wind(0, 1)).record("air", vectors(2)[0]), "has 2 components; it must have 3"),
        (lambda: Lift(0.3).record("wing", *vectors(2, 2, 2), Wind(0, 1)), "has 2 components; it must have 3"),
    ],
)
def test_bad_data_are_refused_with_a_sentence(make: object, sentence: str) -> None:
    with pytest.raises(ValueError, match=re.escape(sentence)):
        make()  # type: ignore[operator]
