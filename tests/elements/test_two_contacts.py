"""A wheel or a point that touches two parts of a road of different friction: the frictions count by their loads."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from mbs.elements import ContactPoints, PlaneRoad
from tests.elements import harness
from tests.elements.harness import Element, vectors
from tests.elements.tyre_data import TYRE, tyre_element, upright

CONTACT = ContactPoints(2e5, 2e5, 1e4, onset=0.005, friction_factor=0.5)
AWAY = -10.0  # m: a plane that is not touched


@dataclass(frozen=True)
class TwoPlanes(PlaneRoad):
    """Two level planes, see two_planes.c."""

    first: tuple[float, float] = (0.0, 1.0)
    second: tuple[float, float] = (AWAY, 1.0)

    @property
    def real(self) -> list[float]:
        """Height and friction of both."""
        return [*self.first, *self.second]


@pytest.fixture(autouse=True, scope="module")
def _two_planes(tmp_path_factory: pytest.TempPathFactory) -> object:
    """The elements over that road."""
    library = harness.compiled(Path(__file__).with_name("two_planes.c"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(harness, "library", lambda: library)
        yield


def point(*planes: tuple[float, float]) -> harness.Result:
    """A point at the origin that slides along (3, 4) m/s, 1 cm in the steps, over planes of heights and frictions."""
    o, x, y, z = vectors(3, 3, 3, 3)
    e = Element(
        CONTACT.record("foot", o, (x, y, z), [[0.0, 0.0, 0.0]], 0), TwoPlanes(first=planes[0], second=planes[1])
    )
    return e(np.r_[0.0, 0.0, 0.0, np.eye(3).ravel()], np.r_[3.0, 4.0, np.zeros(10)], h=0.01)


def test_a_point_slides_over_both_as_over_each_alone() -> None:
    rough, icy = (0.004, 0.9), (0.011, 0.1)
    both = point(rough, icy)
    alone = [point(rough, (AWAY, 1.0)), point((AWAY, 1.0), icy)]
    np.testing.assert_allclose(both.f[:3], alone[0].f[:3] + alone[1].f[:3], rtol=1e-12)
    assert both.out["normal_force"] == pytest.approx(sum(r.out["normal_force"] for r in alone), rel=1e-12)
    assert np.hypot(*both.f[:2]) == pytest.approx(
        0.5 * (0.9 * alone[0].out["normal_force"] + 0.1 * alone[1].out["normal_force"]), rel=1e-12
    )
    np.testing.assert_allclose(point(icy, rough).f, both.f, rtol=1e-12)


def tyre(first: tuple[float, float], second: tuple[float, float]) -> harness.Result:
    """A wheel that slides sideways at 20 m/s, locked, over planes of heights and frictions."""
    element = tyre_element(road=TwoPlanes(first=first, second=second))
    return element(upright(TYRE.radius), np.r_[0.0, 20.0, np.zeros(5)])


def test_a_wheel_grips_by_the_mean_of_the_frictions_weighted_with_their_loads() -> None:
    mu, heights = TYRE.reference_friction, (0.005, 0.015)
    rough, icy = (heights[0], mu), (heights[1], 0.2 * mu)
    loads = [tyre((h, mu), (AWAY, mu)).out["vertical_force"] for h in heights]
    mean = (loads[0] * mu + loads[1] * 0.2 * mu) / sum(loads)
    mixed, even = tyre(rough, icy), tyre((heights[0], mean), (heights[1], mean))
    assert mixed.out["vertical_force"] == pytest.approx(sum(loads), rel=1e-12)
    assert mixed.out["lateral_force"] == pytest.approx(even.out["lateral_force"], rel=1e-12)
    assert abs(even.out["lateral_force"]) < 0.6 * abs(tyre((heights[0], mu), (heights[1], mu)).out["lateral_force"])
    np.testing.assert_allclose(tyre(icy, rough).f, mixed.f, rtol=1e-9, atol=1e-9)
