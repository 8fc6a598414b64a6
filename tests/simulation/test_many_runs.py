"""Many variants of a System at once: each with the numbers of a run of its own."""

import math
import re
import warnings

import numpy as np
import pytest

from mbs import (
    ParameterWarning,
    Pose,
    Settings,
    Simulation,
    SimulationError,
    Variant,
    compile,
    simulate,
    simulate_many,
)
from mbs.common.errors import ArgumentTypeError
from mbs.kernel.binding.many import widest_lanes
from mbs.scenes import assembly_defect_four_bar, double_four_bar
from tests.simulation.many_cars import CARS, SLALOM, system

# Two of the cars have springs with which no car works, so that their steps are halved and refused.
pytestmark = [
    pytest.mark.filterwarnings("ignore::mbs.ParameterWarning"),
    pytest.mark.filterwarnings(
        "ignore:Variant .. At .* too fast:mbs.results.accuracy.AccuracyWarning"
    ),  # stiff wheels at kerbs
]

VARIANTS = list(CARS.values())


def test_trajectories_are_those_of_single_runs() -> None:
    """Two threads, groups that are not full, a record of every third step and times, units and counters."""
    runs = simulate_many(system(), VARIANTS, 0.5, 0.01, every=3, threads=2, progress=False, estimate_error=False)
    assert runs.failures == {}
    reports = [run.report for run in runs.trajectories if run is not None]
    assert [steps > 0 for steps in runs.alone] == [r is not None and r.divisions > 0 for r in reports]
    assert 0 < sum(steps > 0 for steps in runs.alone) < len(VARIANTS)
    assert runs.lanes == min(widest_lanes(), 8)
    for variant, run in zip(VARIANTS, runs.trajectories, strict=True):
        one = simulate(
            system(),
            0.5,
            0.01,
            variant.inputs,
            parameters=variant.parameters,
            pose=variant.pose,
            every=3,
            estimate_error=False,
        )
        assert run is not None
        assert run.report == one.report
        assert run.units == one.units
        np.testing.assert_array_equal(run.t, one.t)
        for name in run.units:
            np.testing.assert_array_equal(run[name], one[name], err_msg=name)


@pytest.mark.filterwarnings(
    "ignore:Variant 0. At .* rebound stop:mbs.results.accuracy.AccuracyWarning"
)  # at 40 ms it is so
def test_a_failed_run_is_reported_and_leaves_the_others() -> None:
    """A start below the road and a step that is refused, beside a slalom that goes on to its end."""
    high = CARS["stiff tyre at a kerb"]
    variants = [Variant(inputs=SLALOM, pose=Pose(speed=15.0)), Variant(pose=Pose(z=-2.0)), high]
    settings = Settings(max_halvings=0)
    runs = simulate_many(system(), variants, 4.0, 0.04, settings=settings, progress=False)
    assert set(runs.failures) == {1, 2}
    assert runs.trajectories[1] is None
    whole, part = runs.trajectories[0], runs.trajectories[2]
    assert whole is not None
    assert part is not None
    assert len(whole.t) == 101
    with pytest.raises(SimulationError) as alone:
        simulate(system(), 4.0, 0.04, high.inputs, settings, high.parameters, pose=high.pose, estimate_error=False)
    assert str(runs.failures[2]) == str(alone.value)
    assert alone.value.trajectory is not None
    np.testing.assert_array_equal(part.t, alone.value.trajectory.t)
    assert runs.failures[2].trajectory is part
    assert runs.alone[2] >= 1


def test_progress_reaches_the_end() -> None:
    shares: list[float] = []
    simulate_many(system(), VARIANTS[:3], 0.1, 0.01, progress=shares.append, estimate_error=False)
    assert shares[-1] == 1.0
    assert shares == sorted(shares)


def test_no_variants_are_no_runs() -> None:
    runs = simulate_many(system(), [], 0.1, 0.01)
    assert (runs.trajectories, runs.failures, runs.alone) == ([], {}, [])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"settings": Settings(method="radau_5")}, "'radau_5'; it must be 'ali3p'"),
        ({"lanes": 3}, "lanes = 3; it must be 2, 4 or 8"),
        ({"threads": 0}, "The threads is 0"),
        ({"h": 0.0}, "must be positive"),
        ({"t_end": math.nan}, "The end t_end"),
        ({"variants": [Variant(inputs={"stering": 0.1})]}, "Variant 0: There is no input 'stering'"),
        ({"variants": [Variant(), Variant({"road.kerb_x": 1e9})]}, "Variant 1: "),
        ({"variants": [Variant(), Variant(inputs={"steering": ([0.0, 1.0], [0.0, 5.0])})]}, "Variant 1: Input 'steer"),
    ],
)
def test_bad_arguments_are_refused(arguments: dict[str, object], message: str) -> None:
    all_arguments = {"variants": [Variant()], "t_end": 1.0, "h": 0.01} | arguments
    with pytest.raises(ValueError, match=re.escape(message)):
        simulate_many(system(), **all_arguments)  # type: ignore[arg-type]


def test_a_variant_is_a_variant() -> None:
    with pytest.raises(ArgumentTypeError, match=r"Variant 0 .* a Variant"):
        simulate_many(system(), [{}], 1.0, 0.01)  # type: ignore[list-item]
    with pytest.raises(ArgumentTypeError, match=r"The variants must be a list of Variant"):
        simulate_many(system(), None, 1.0, 0.01)  # type: ignore[arg-type]


def test_a_value_with_which_no_car_works_is_reported_with_the_number_of_its_variant() -> None:
    """And each of them once, whatever their order in groups."""
    variants = [Variant(), Variant({"front.tyre.stiffness": 1.2e6}), Variant({"front.tyre.stiffness": 1.3e6})]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        simulate_many(system(), variants, 0.02, 0.002, lanes=2, progress=False)
    messages = [str(w.message) for w in caught if w.category is ParameterWarning]
    assert [line.partition(", outside")[0] for line in messages] == [
        f"Variant {k}: Parameter 'front.tyre.stiffness' is set to 1.{k + 1}e+06 N/m" for k in (1, 2)
    ]


@pytest.mark.parametrize("pose", [None, Pose(z=0.02, speed=8.0)])
def test_the_first_rows_are_those_of_single_runs(pose: Pose | None) -> None:
    """Accelerations at the start are those under the inputs at the start, which begin at other values than declared."""
    car, inputs = system(), {"throttle": 0.4, "steering": ([0.0, 0.4], [0.3, -0.2])}
    runs = simulate_many(car, [Variant(inputs=inputs, pose=pose)] * 2, 0.006, 0.002, lanes=2, progress=False)
    assert runs.failures == {}
    one = simulate(car, 0.006, 0.002, inputs, pose=pose, estimate_error=False)
    start = Simulation(car, inputs={"throttle": 0.4, "steering": 0.3}, pose=pose).sensors
    run = runs.trajectories[1]
    assert run is not None
    for sensor in run.units:
        np.testing.assert_array_equal(run[sensor], one[sensor], err_msg=sensor)
        assert run[sensor][0] == start[sensor], sensor


def test_planar_mechanisms_advance_in_lanes() -> None:
    """Through singular positions."""
    mechanism = compile(double_four_bar.build(2))
    runs = simulate_many(mechanism, [Variant()] * 3, 5.0, 0.01, lanes=2, threads=1, progress=False)
    assert runs.alone == [0, 0, 500]  # the last has no neighbour
    one = simulate(mechanism, 5.0, 0.01, estimate_error=False, progress=False)
    for run in runs.trajectories:
        assert run is not None
        for name in run.units:
            np.testing.assert_array_equal(run[name], one[name], err_msg=name)


def test_flexible_mechanisms_advance_in_lanes() -> None:
    """With the section forces that follow from their amplitudes; the first steps are damped, each alone."""
    mechanism = compile(assembly_defect_four_bar.build())
    runs = simulate_many(
        mechanism, [Variant()] * 2, 0.5, 0.01, lanes=2, threads=1, progress=False, estimate_error=False
    )
    assert runs.alone == [6, 6]
    one = simulate(mechanism, 0.5, 0.01, estimate_error=False, progress=False)
    for run in runs.trajectories:
        assert run is not None
        assert run.report == one.report
        for name in run.units:
            np.testing.assert_array_equal(run[name], one[name], err_msg=name)
