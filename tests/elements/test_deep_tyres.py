"""Wheels deep in the road: loads grow with the depth, no force changes its sign, the deflection is reported."""

from functools import cache

import numpy as np
import pytest

from mbs.elements import GridRoad, KerbRoad, PlaneRoad
from tests.elements.harness import Element
from tests.elements.test_magic_tyre import FILES, OWN, element_of, tyre_file
from tests.elements.tyre_data import tyre_element

FLAT = np.zeros((9, 9))
ROADS = {
    "plane": PlaneRoad(friction=0.9),
    "lower plane of a kerb": KerbRoad(50.0, 0.1, 0.0, "after", 0.9),
    "upper plane of a kerb": KerbRoad(-50.0, 1.0, -1.0, "after", 0.9),
    "grid": GridRoad((-4.0, -4.0), (1.0, 1.0), FLAT, 0.9),
}
STILL = 1e-3  # of the load: what counts as a force


def softening(element: Element) -> Element:
    """Its spring would pull from half a radius on."""
    names = element.element.real_names
    stiffness, radius = (element.element.real[names.index(name)] for name in ("stiffness", "radius"))
    return element.with_reals({"progression": -2.0 * stiffness / radius, "bottoming_stiffness": 0.0})


@cache
def tyres() -> dict[str, Element]:
    results = {"TMeasy": tyre_element()}
    for file in (OWN[0], OWN[1], FILES[-1]):
        results[file.name] = element_of(tyre_file(file).tyre())
    return results | {f"{OWN[0].name}, softening": softening(element_of(tyre_file(OWN[0]).tyre()))}


def at_depths(element: Element, lean: float, speed: float, aside: float, spin: float):
    """Settled outputs at depths from nearly 0 to twice the radius along the disc."""
    radius = element.element.real[0]
    axis = np.array([0.0, np.cos(lean), np.sin(lean)])
    height = abs(np.cos(lean)) if abs(np.cos(lean)) > 0.5 else 0.25 * (1.0 + 4.0 * np.cos(lean) ** 2)
    depths = np.linspace(0.01, 2.0, 15) * radius
    rows = []
    for depth in depths:
        u, y = np.r_[0.0, 0.0, (radius - depth) * height, axis, 0.0], None
        for _ in range(12):
            r = element(u, np.r_[speed, aside, 0.0, 0.0, 0.0, 0.0, spin], y, 0.05)
            y = r.y
        rows.append(r.out)
    return depths, {name: np.array([row[name] for row in rows]) for name in rows[0]}


@pytest.mark.parametrize(
    ("road", "lean"), [("plane", lean) for lean in (0.0, 1.3, np.pi / 2.0)] + [(road, 0.5) for road in ROADS][1:]
)
def test_load_grows_and_forces_keep_their_sign(road: str, lean: float) -> None:
    count = 0
    for name, element in tyres().items():
        element.road = ROADS[road]
        for speed, aside, spin in ((10.0, 0.0, 0.0), (0.0, 0.0, 30.0), (10.0, 0.0, 200.0), (10.0, 3.0, 90.0)):
            depths, out = at_depths(element, lean, speed, aside, spin)
            load = out["vertical_force"]
            assert np.all(np.diff(load) > 0.0 if "softening" not in name else np.diff(load) >= 0.0), name
            np.testing.assert_allclose(np.diff(out["deflection"]), np.diff(depths), rtol=1e-9, err_msg=name)
            # where nothing slips aside, shifts of the Magic Formula do as they like
            for force in ("longitudinal_force", "lateral_force")[: 2 if aside else 1]:
                signs = np.sign(out[force][np.abs(out[force]) > STILL * load])
                assert np.ptp(signs) == 0.0 if len(signs) else True, (name, force, speed, spin)
                count += len(signs) > 0
    assert count > 12
