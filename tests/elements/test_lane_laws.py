"""The law of an element in a lane has the bits of the element alone, independent of the other lanes."""

import ctypes
from dataclasses import replace

import numpy as np
import pytest

from mbs.elements import Brake, Drag, EndStops, GyroscopicSpin, KerbRoad, PlaneRoad, SpinAngle, SpringDamper, TyreBore
from mbs.kernel.header.enumerations import ElementType
from tests.elements.harness import Element, library, vectors
from tests.elements.test_fuzz import awkward
from tests.elements.tyre_data import TYRE, tyre_element

WIDTH = 2
SUDDEN = EndStops(0.4, 1e5, 0.6, 1e5)
SOFT = EndStops(0.4, 1e5, 0.6, 2e5, 0.01, 0.0, 0.02, 0.03, 1e6, 0.01, 0.3, 0.2)
POINT, F, G, CHI = vectors(3, 3, 3, 1)
ELEMENTS = {
    "spring": Element(SpringDamper(1e4, 1e3, 0.5, SUDDEN).record("s", POINT)),
    "progressive spring": Element(SpringDamper(1e4, 1e3, 0.5, SOFT).record("s", POINT)),
    "gyroscopic spin": Element(GyroscopicSpin(0.5).record("g", F, G, CHI[0])),
    "spin angle": Element(SpinAngle().record("a", F, G, CHI[0])),
    "drag": Element(Drag(0.8).record("d", POINT)),
    "brake": Element(Brake(650.0, 2e5, 600.0).record("b", F, G, CHI[0], 0)),
    "hand brake": Element(Brake(650.0, 2e5, 600.0, 0.4, 300.0).record("b", F, G, CHI[0], 0, 1)),
    "tyre on a plane": tyre_element(road=PlaneRoad(0.1, 0.1, -0.2, 0.8)),
    "tyre with camber": tyre_element(replace(TYRE, camber_slip=0.1), PlaneRoad(0.1, 0.1, -0.2, 0.8)),
    "tyre with bore torque": tyre_element(
        replace(TYRE, camber_slip=0.1, bore=TyreBore(0.12, 4000.0, 25.0)), PlaneRoad(0.1, 0.1, -0.2, 0.8)
    ),
    "tyre before a kerb": tyre_element(road=KerbRoad(0.3, 0.1, 0.0, "before", 0.8)),
    "tyre behind a kerb": tyre_element(road=KerbRoad(0.3, 0.1, 0.0, "after", 0.8)),
}


def near(rng: np.random.Generator, element: Element) -> tuple[np.ndarray, np.ndarray]:
    """Signals and rates as in use: a wheel about the road and the kerb, upright, leaning or lying, a short spring."""
    n = len(element.element.signals)
    u, ud = rng.normal(size=n), rng.choice([0.0, 0.1, 10.0], size=n) * rng.normal(size=n)
    if n == 3:
        return rng.choice([0.0, 0.3, 0.6]) * u, ud
    axis = rng.choice([0.0, 0.0, 1e-3, 0.3, 1.0], size=3) * rng.normal(size=3)
    place = [0.3 + 0.2 * rng.normal(), 0.1 * rng.normal(), rng.uniform(0.05, 0.5)]
    ud[6] = rng.choice([0.0, 1.0, 60.0]) * rng.normal()
    return np.array([*place, *(axis if axis.any() else (0.0, 1.0, 0.0)), *u[6:]]), ud


def together(
    element: Element, u: np.ndarray, ud: np.ndarray, y: np.ndarray, w: tuple[float, ...], inputs_of_lanes: np.ndarray
) -> list[np.ndarray]:
    """What the law gives: f, S, states, outputs and potential, a row for each lane."""
    e, road = element.element, element.road.real
    columns = [np.ascontiguousarray(part.T) for part in (u, ud, y)]
    numbers = np.repeat(np.array(e.real)[:, None], WIDTH, axis=1)
    inputs = np.ascontiguousarray(inputs_of_lanes.T)
    plain = len(road) - 1
    of_road = np.zeros((6, WIDTH))
    of_road[:plain], of_road[5] = np.array(road[:plain])[:, None], road[plain]
    n = len(e.signals)
    outputs = [np.empty((max(1, k), WIDTH)) for k in (n, n * n, len(e.states), len(e.outputs), 1)]
    at = [part.ctypes.data_as(ctypes.c_void_p) for part in (*columns, np.array(w), numbers, inputs, of_road, *outputs)]
    integers = (ctypes.c_int32 * max(1, len(e.integer)))(*e.integer)
    library().lanes_evaluate(
        int(e.type), element.sizes, *at[:5], integers, at[5], int(element.road.type), at[6], *at[7:]
    )
    return [part.T for part in outputs]


@pytest.mark.parametrize("name", ELEMENTS)
def test_a_lane_has_the_bits_of_the_element_alone(name: str) -> None:
    rng, element = np.random.default_rng(7), ELEMENTS[name]
    e, differing = element.element, 0
    n, slots = len(e.signals), len(e.states)
    for draw in range(180):
        lanes = [near(rng, element) if draw % 3 else (awkward(rng, n), awkward(rng, n)) for _ in range(WIDTH)]
        u, ud = np.array([lane[0] for lane in lanes]), np.array([lane[1] for lane in lanes])
        y = 1e-2 * rng.choice([0.0, 1.0, 30.0], size=(WIDTH, slots)) * rng.normal(size=(WIDTH, slots))
        inputs_of_lanes = rng.choice([0.0, 0.1, 1.0], size=(WIDTH, 4))
        h = float(rng.choice([0.0, 1e-3, 1e-2]))
        reach = float(rng.choice([0.0, 0.1, 10.0]))
        result = together(element, u, ud, y, (h, 0.5 * h, 0.25 * h * h, reach), inputs_of_lanes)
        for k in range(WIDTH):
            alone = element(u[k], ud[k], y[k], h, 0.5 * h, 0.25 * h * h, inputs_of_lanes[k], reach=reach)
            expected = [alone.f, alone.S.ravel(), alone.y, np.array([*alone.out.values()]), np.array([alone.potential])]
            for got, alone_part in zip(result, expected, strict=True):
                assert got[k, : alone_part.size].tobytes() == alone_part.tobytes(), (draw, k, u[k], ud[k])
        differing += not np.array_equal(*np.hstack([result[0], result[3]]))
    assert differing > 80


def test_laws_are_those_of_the_list() -> None:
    have = {t for t in ElementType if library().lanes_have_law(int(t))}
    assert have == {e.element.type for e in ELEMENTS.values()}
