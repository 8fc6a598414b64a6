"""Cross-sections and materials against closed forms, and messages for invalid ones."""

import numpy as np
import pytest

from mbs.common.errors import ModelError
from mbs.flexible.material import Material
from mbs.flexible.section import rectangle, round_bar, tube

ROUND_OFF = 1e-12
COWPER = 1e-12
SAINT_VENANT = 1e-4  # published factor has four digits
THIN = 1e-3


def test_round_bar_has_the_constants_of_the_circle() -> None:
    bar = round_bar(0.02)
    assert bar.area == pytest.approx(np.pi * 0.01**2, rel=ROUND_OFF)
    assert bar.Iy == bar.Iz == pytest.approx(np.pi / 4 * 0.01**4, rel=ROUND_OFF)
    np.testing.assert_allclose(bar.J, np.pi / 2 * 0.01**4, rtol=ROUND_OFF)
    assert bar.shear_factors(0.3)[0] == pytest.approx(6 * 1.3 / (7 + 6 * 0.3), rel=COWPER)


def test_thin_tube_has_the_limits_of_the_thin_ring() -> None:
    ring = tube(0.1, 1e-5)
    radius, wall = 0.05 - 0.5e-5, 1e-5
    assert ring.area == pytest.approx(2 * np.pi * radius * wall, rel=ROUND_OFF)
    assert ring.Iy == pytest.approx(np.pi * radius**3 * wall, rel=THIN)
    assert ring.shear_factors(0.3)[0] == pytest.approx(2 * 1.3 / (4 + 3 * 0.3), rel=THIN)


def test_square_twists_with_saint_venants_factor() -> None:
    np.testing.assert_allclose(rectangle(0.02, 0.02).J, 0.140577 * 0.02**4, rtol=SAINT_VENANT)


def test_flat_rectangle_bends_harder_about_its_short_axis_and_twists_like_a_strip() -> None:
    flat = rectangle(width=0.1, height=0.001)
    assert flat.Iz / flat.Iy == pytest.approx(1e4, rel=ROUND_OFF)
    # the strip's a b3 / 3 less its ends, 0.63 b / a
    np.testing.assert_allclose(flat.J, 0.1 * 0.001**3 / 3 * (1 - 0.630 * 0.01), rtol=SAINT_VENANT)


def test_first_two_fibres_are_the_highest_and_the_lowest() -> None:
    for section in (tube(0.04, 0.002), rectangle(0.03, 0.05)):
        heights = [z for _, z in section.fibres]
        assert section.fibres[0][1] == max(heights)
        assert section.fibres[1][1] == min(heights)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: tube(0.02, 0.011), "at most half the diameter"),
        (lambda: tube(-0.02, 0.001), "outer_diameter of a tube is -0.02"),
        (lambda: rectangle(0.0, 0.01), "width of a rectangle"),
        (lambda: Material(210000.0 * 1e-6, 0.3, 7850.0), "does not look like pascals"),
        (lambda: Material(2.1e11, 0.3, 7.85e-9), "does not look like kg/m3"),
        (lambda: Material(2.1e11, 0.7, 7850.0), "between -1 and 0.5"),
    ],
)
def test_impossible_sections_and_materials_are_refused_in_one_sentence(make: object, sentence: str) -> None:
    with pytest.raises(ModelError, match=sentence):
        make()  # type: ignore[operator]
