"""Any finite input gives finite output."""

import numpy as np
import pytest

from mbs import elements
from tests.elements.harness import Element, contacts, signals, vectors
from tests.elements.tyre_data import tyre_element

LARGEST = 30  # decades; beyond, products overflow and the kernel refuses the step
ROADS = {
    "plane": elements.PlaneRoad(0.1, 0.1, -0.2, 0.8),
    "kerb": elements.KerbRoad(0.3, 0.1, 0.0, "before", 0.8),
    "kerb up": elements.KerbRoad(0.3, 0.1, 0.0, "after", 0.8),
    "grid": elements.GridRoad((-1.0, -1.0), (0.5, 0.5), 0.1 * np.sin(np.arange(36.0)).reshape(6, 6), 0.8),
}


def laws() -> dict[str, Element]:
    p, a, b, c = vectors(3, 3, 3, 3)
    f, g, chi = vectors(3, 3, 1)
    left, right, f2, g2 = vectors(1, 1, 3, 3)
    shafts = left[0], right[0], f2, g2
    return {
        "spring": Element(elements.SpringDamper(1e4, 1e3, 0.5, elements.EndStops(0.4, 1e5, 0.6, 1e5)).record("s", p)),
        "scalar spring": Element(elements.ScalarSpringDamper(30.0, 2.0).record("s", signals(1)[0])),
        "input force": Element(elements.InputForce(0, (1.0, 2.0)).record("i", signals(2))),
        "body force": Element(elements.BodyForce((0, 1, None)).record("f", p, (a, b, c))),
        "body torque": Element(elements.BodyTorque((0, 1, 2), "body").record("t", vectors(3, 3, 3))),
        "gyroscopic spin": Element(elements.GyroscopicSpin(0.5).record("g", f, g, chi[0])),
        "spin angle": Element(elements.SpinAngle().record("a", f, g, chi[0])),
        "spin torque": Element(elements.SpinTorque(1, 2.0).record("t", f, g, chi[0])),
        "drag": Element(elements.Drag(0.8).record("d", p)),
        "spring by table": Element(
            elements.SpringDamperTable(
                ((-0.2, -9e3), (-0.1, -2e3), (0.1, 2e3)), ((-1.0, -2e3), (0.0, 0.0), (0.5, 500.0)), 0.5
            ).record("s", p)
        ),
        "drag in wind": Element(elements.WindDrag(0.8, wind=elements.Wind(0, 1)).record("d", p)),
        "lift in wind": Element(elements.Lift(0.3).record("l", p, a, b, elements.Wind(0, 1))),
        "wrench on a hub": Element(elements.HubWrench((0, 1, 0, 1, 0, 1)).record("w", p, a, chi[0])),
        "lift": Element(elements.Lift(0.3).record("l", p, a, b)),
        "brake": Element(elements.Brake(650.0, 2e5, 600.0).record("b", f, g, chi[0], 0)),
        "coordinate friction": Element(elements.CoordinateFriction(2.0, 400.0, 7.0).record("f", signals(1)[0])),
        "torsion bar": Element(elements.TorsionBar(100.0, 1.0, 8.0, 40.0).record("t", *signals(2))),
        "hand brake": Element(elements.Brake(650.0, 2e5, 600.0, 0.4, 300.0).record("b", f, g, chi[0], 0, 1)),
        "drive": Element(elements.AutomaticDrive(110.0, 5e4).record("a", *shafts, 0)),
        "drive with a selector": Element(elements.AutomaticDrive(110.0, 5e4).record("a", *shafts, 0, selector=1)),
        "electric drive": Element(elements.ElectricDrive(250.0, 1e5, 9.5).record("e", *shafts, 0)),
        "electric drive with a selector": Element(
            elements.ElectricDrive(250.0, 1e5, 9.5, regeneration_torque=50.0).record("e", *shafts, 0, 1)
        ),
        **{f"tyre on {name}": tyre_element(road=road) for name, road in ROADS.items()},
    }


def awkward(rng: np.random.Generator, n: int | tuple[int, int]) -> np.ndarray:
    """Numbers of all sizes, many of them zero or one."""
    sizes = rng.choice([-300.0, -20.0, -3.0, 0.0, 1.0, 5.0, LARGEST], size=n, p=[0.05, 0.05, 0.2, 0.4, 0.2, 0.05, 0.05])
    values = rng.choice([-1.0, 0.0, 1.0, 0.3, -0.7], size=n) * 10.0**sizes
    return np.asarray(values * np.where(rng.random(n) < 0.5, 1.0, rng.random(n)))


@pytest.mark.parametrize("name", list(laws()))
def test_finite_in_finite_out(name: str) -> None:
    element, rng = laws()[name], np.random.default_rng(18)
    n, states = len(element.element.signals), len(element.element.states)
    touched, count = 0, 500
    drawn = [awkward(rng, (count, k)) for k in (n, n, states, 4)]
    for i, (u, ud, y, inputs) in enumerate(zip(*drawn, strict=True)):
        if name.startswith("tyre") and i % 2:  # half of them near the road
            u = np.r_[rng.normal(size=2), rng.uniform(0.0, 0.4), rng.normal(size=3), 0.0]
        h = float(rng.choice([0.0, 1e-9, 1e-3, 1e-2, 1.0, 1e3]))
        r = element(u, ud, y, h, 0.5 * h, 0.25 * h * h, inputs)
        again = element(u, ud, y, h, 0.5 * h, 0.25 * h * h, np.zeros(4))
        values = np.concatenate([r.f, r.S.ravel(), r.y, list(r.out.values()), [r.potential]])
        assert np.all(np.isfinite(values)), (u, ud, y, h)
        assert np.array_equal(r.S, r.S.T)
        if h == 0.0:
            kept = np.ones(len(y), bool)
            if name.startswith("tyre"):
                kept[[2, 3, *range(5, len(y))]] = False  # rates of a carcass follow from its deflections
            assert np.array_equal(again.y[kept], y[kept])
        touched += bool(np.any(r.f != 0.0))
    if name == "spin angle":
        assert touched == 0
    else:
        assert touched > (50 if "selector" in name else 100)  # half of the positions are neutral


@pytest.mark.parametrize("name", list(ROADS))
def test_roads_give_unit_normals_everywhere(name: str) -> None:
    rng = np.random.default_rng(20)
    for _ in range(500):
        axis = rng.choice([rng.normal(), 0.0, 1.0], size=3)
        if not np.any(axis):
            continue
        axis /= np.linalg.norm(axis)
        centre = rng.normal(size=3) * 10.0 ** rng.integers(-3, 9)
        result = contacts(ROADS[name], centre, axis, 0.3)
        assert 1 <= len(result) <= 2
        for c in result:
            assert all(np.all(np.isfinite(v)) for v in c.values())
            assert np.linalg.norm(c["normal"]) == pytest.approx(1.0, abs=1e-9)
            assert np.linalg.norm(c["down"]) == pytest.approx(1.0, abs=1e-9)
            assert c["down"] @ axis == pytest.approx(0.0, abs=1e-6)
            assert 0.0 < c["cosine"] <= 1.0 + 1e-12
