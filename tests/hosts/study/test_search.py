"""The search for a target value, on functions with known solutions."""

import math
from collections.abc import Callable

import pytest

from hosts.study.target_search import SearchResult, TargetSearch


def sought(function: Callable[[float], float], target: float, low: float, high: float, **more: float) -> SearchResult:
    def measure(x: float) -> tuple[float, str]:
        return function(x), "" if math.isfinite(function(x)) else "failed"

    result = TargetSearch(measure, target, (low, high), **more).search()
    assert len({run.x for run in result.runs}) == len(result.runs)  # no run twice
    return result


def test_a_monotone_measure_is_met_by_few_runs() -> None:
    actual = sought(lambda x: x**3, 20.0, 1.0, 4.0)
    assert actual.met
    assert actual.best is not None
    assert actual.best.x == pytest.approx(20.0 ** (1 / 3), rel=1e-3)
    assert len(actual.runs) <= 8
    assert actual.slope == pytest.approx(3.0 * 20.0 ** (2 / 3), rel=0.05)
    assert (actual.rises, actual.falls) == (True, False)


@pytest.mark.parametrize(
    ("top", "law"), [(4.0, lambda x: x - 0.7 + (x - 2.0) ** 3), (19000.0, lambda x: 1.174 + 0.69 / (1.0 + x / 800.0))]
)
def test_the_slope_is_that_of_a_run_beside_it(top: float, law: Callable[[float], float]) -> None:
    """The secant of the ends meets the first, with a slope of 5; in the second it is another one at the left."""
    actual = sought(law, 1.3, 0.0, top)
    assert actual.best is not None
    h = 1e-4 * actual.best.x
    assert actual.slope == pytest.approx((law(actual.best.x + h) - law(actual.best.x - h)) / (2.0 * h), rel=0.02)
    assert abs(actual.between[1] - actual.between[0]) == pytest.approx(0.01 * actual.between[0])


def test_a_far_target_does_not_hide_the_slope_of_a_measure() -> None:
    """A thousandth of what is wanted is more than all that the measure changes by."""
    far = sought(lambda x: 9.0 + x, 1e4, 0.0, 1.0)
    assert (far.met, far.rises, far.falls) == (False, True, False)
    near = sought(lambda x: 3.13 - 0.066 * x, 50.0, 0.0, 1.0)
    assert (near.rises, near.falls) == (False, True)
    still = sought(lambda x: 9.0 + 1e-3 * x, 1e4, 0.0, 1.0)
    assert (still.rises, still.falls) == (False, False)


def test_two_solutions_inside_the_range_and_the_one_near_the_start() -> None:
    for start, x in ((0.5, 1.0), (3.5, 3.0)):
        actual = sought(lambda x: (x - 2.0) ** 2, 1.0, 0.0, 4.0, start=start)
        assert actual.met
        assert actual.best is not None
        assert actual.best.x == pytest.approx(x, abs=2e-3)
        assert actual.rises
        assert actual.falls


def test_a_value_that_is_not_reached_gives_the_nearest() -> None:
    actual = sought(lambda x: 2.0 + (x - 1.0) ** 2, 1.0, 0.0, 4.0)
    assert (actual.met, actual.crossed) == (False, False)
    assert actual.best is not None
    assert actual.best.x == pytest.approx(1.0, abs=0.1)
    assert actual.best.y == pytest.approx(2.0, abs=0.01)
    end = sought(lambda x: x, 5.0, 0.0, 4.0)
    assert end.best is not None
    assert end.best.x == 4.0
    assert not end.met


@pytest.mark.parametrize(
    "law", [lambda x: x, lambda x: -(x**2), lambda x: 1.0, lambda x: 0.1 * x + 1e-4 * math.sin(9.0 * x)]
)
def test_few_runs_show_that_a_value_is_not_reached(law: Callable[[float], float]) -> None:
    actual = sought(law, 5.0, 0.0, 4.0)
    assert len(actual.runs) <= 12
    assert (actual.met, actual.crossed) == (False, False)
    assert actual.best is not None
    assert abs(actual.best.y - 5.0) == min(abs(law(x) - 5.0) for x in (0.0, 4.0))
    assert math.isnan(actual.slope)


def test_an_extremum_that_no_line_through_the_ends_shows_is_sought() -> None:
    """Beyond the value between ends that are alike, in the middle or beside it; and short of it by a little."""
    for top in (1.7, 2.0, 3.1):
        result = sought(lambda x, top=top: 5.3 - (x - top) ** 2, 5.0, 0.0, 4.0)
        assert result.met
    short = sought(lambda x: 4.9 - (x - 1.4) ** 2, 5.0, 0.0, 4.0)
    assert short.best is not None
    assert short.best.x == pytest.approx(1.4, abs=0.1)


def test_a_jump_is_not_taken_for_a_solution() -> None:
    actual = sought(lambda x: -1.0 if x < math.pi / 4 else 3.0, 1.0, 0.0, 1.0)
    assert (actual.met, actual.crossed) == (False, True)
    assert actual.best is not None
    assert actual.best.x == pytest.approx(math.pi / 4, abs=1e-3)


def test_runs_that_fail_at_the_ends_and_between() -> None:
    actual = sought(lambda x: math.nan if x < 0.5 or abs(x - 2.0) < 0.3 else x, 3.0, 0.0, 4.0)
    assert actual.met
    assert actual.runs[0].reason == "failed"
    nothing = sought(lambda x: math.nan, 3.0, 0.0, 4.0)
    assert nothing.best is None
    assert len(nothing.runs) == 7


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_measure_that_only_the_far_part_of_the_range_yields_is_found_there(sign: float) -> None:
    actual = sought(lambda x: x if sign * x > 0.3 else math.nan, 0.7 * sign, -1.0, 1.0)
    assert actual.met
    assert actual.best is not None
    assert actual.best.x == pytest.approx(0.7 * sign, abs=1e-3)


def test_zero_is_wanted_with_a_range_by_the_logarithm() -> None:
    actual = sought(lambda x: math.log10(x), 0.0, 0.01, 1000.0, log=True)
    assert actual.met
    assert actual.best is not None
    assert actual.best.x == pytest.approx(1.0, rel=0.02)
