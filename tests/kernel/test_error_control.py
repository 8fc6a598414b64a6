"""Error-controlled runs of the kernel: state after a call, ends of steps, and a run in parts."""

import math

import numpy as np
import pytest

from mbs.kernel.binding import ControlFields, KernelError, LoadedSystem, Status
from mbs.kernel.binding.instance import Instance
from mbs.kernel.header.enumerations import DrivingFunctionType
from mbs.settings.methods import METHOD_TABLE

from .scenes import everything, four_bar, pendulum
from .system_builder import Row, SystemBuilder

METHODS = {
    n: METHOD_TABLE[n].number for n in ("ali3p", "energy_momentum", "energy_momentum_4", "runge_kutta_8", "radau_5")
}


def start(builder: SystemBuilder, method: int = 0) -> Instance:
    instance = Instance(LoadedSystem(builder.to_bytes()))
    instance.set_settings(method=method, tolerance_r=1e-13, tolerance_phi=1e-13)
    instance.initialise(0.0)
    return instance


def control(tolerance: float = 1e-4, span: float = 2.0, **more: float) -> ControlFields:
    return ControlFields(**({"tolerance": tolerance, "length": 1.0, "span": span, "rate": 3.0, "longest": 0.2} | more))


def run(
    instance: Instance, fields: ControlFields, times: np.ndarray, most: int = 10**6, t_end: float = 2.0
) -> tuple[np.ndarray, np.ndarray]:
    sizes = instance.system.sizes
    sensors, positions = np.full((len(times), sizes.ns), np.nan), np.full((len(times), sizes.nq), np.nan)
    done = 0
    for _ in range(10**6):
        done = instance.control_run(fields, np.ones(sizes.nq), t_end, most, times, sensors, positions, done)
        if instance.time >= t_end:
            break
    assert done == len(times)
    return sensors, positions


@pytest.mark.parametrize("method", METHODS)
def test_a_run_in_parts_is_the_run(method: str) -> None:
    times = np.linspace(0.0, 2.0, 41)[1:]
    results = []
    for most in (1, 3, 10**6):
        instance, fields = start(four_bar(), METHODS[method]), control()
        results.append((*run(instance, fields, times, most), np.frombuffer(instance.save(), np.uint8)))
        assert instance.time == 2.0
    for other in results[1:]:
        for one, same in zip(results[0], other, strict=True):
            assert one.tobytes() == same.tobytes()


@pytest.mark.parametrize(
    ("method", "order", "loose", "tight"),
    [("ali3p", 2, 1e-2, 1e-4), ("radau_5", 5, 1e-3, 1e-7), ("runge_kutta_8", 8, 1e-5, 1e-10)],
)
def test_the_number_of_steps_goes_with_the_order(method: str, order: int, loose: float, tight: float) -> None:
    counts = []
    for tolerance in (loose, tight):
        fields = control(tolerance, 20.0, longest=2.0)
        run(start(pendulum(), METHODS[method]), fields, np.array([20.0]), t_end=20.0)
        counts.append(fields.accepted)
    growth = math.log(counts[1] / counts[0]) / math.log(loose / tight)
    assert growth == pytest.approx(1.0 / order, rel=0.25)


@pytest.mark.parametrize(
    ("method", "share"),
    [("ali3p", 1e-4), ("energy_momentum_4", 1e-4), ("radau_5", 1e-6), ("runge_kutta_8", 1e-6)],
)
def test_the_shortest_step_is_that_of_the_method(method: str, share: float) -> None:
    """Of the time scale of the motion, here one over the rate: below it, round-off of index three grows."""
    least = share / 3.0
    fields = control(0.5, h=0.01 * least)
    instance = start(pendulum(), METHODS[method])
    done = np.array([2.0])
    sizes = instance.system.sizes
    instance.control_run(fields, None, 2.0, 1, done, np.zeros((1, sizes.ns)), np.zeros((1, sizes.nq)), 0)
    assert fields.accepted == 1
    assert fields.h == pytest.approx(least, rel=1e-6)


def test_errors_add_up_to_the_tolerance() -> None:
    for tolerance in (1e-3, 1e-5):
        fields = control(tolerance)
        run(start(pendulum()), fields, np.array([2.0]))
        assert 0.1 * tolerance < fields.error_sum <= tolerance
        assert fields.forced == 0
        assert fields.forced_error == 0.0


def test_the_error_of_a_tolerance_that_cannot_be_kept_is_reported() -> None:
    """Steps of index three are not made shorter than a part of the time scale: there they err by too much."""
    fields = control(1e-16)
    start(pendulum()).control_run(fields, None, 2.0, 50, np.empty(0), None, None, 0)
    assert 0 < fields.forced <= fields.accepted
    assert 1e-16 < fields.forced_error <= fields.error_sum


def test_the_last_two_steps_share_the_remaining_time() -> None:
    """Of free fall, which every method follows exactly."""
    fields = control(h=0.3, longest=0.3)
    run(start(SystemBuilder(np.array([[1.0]]), [0.0], gravity=[-9.81])), fields, np.array([1.0]), t_end=1.0)
    assert fields.accepted == 4
    assert fields.smallest == pytest.approx(0.2, rel=1e-9)


def test_step_sizes_follow_the_controller_of_gustafsson() -> None:
    """h1 / h0 = (AIM / e1)^(0.7 k) (e0 / AIM)^(0.4 k), k = 1 / (order + 1), with e the part of what a step may err."""
    tolerance, span, k, aim = 1e-4, 2.0, 1.0 / 3.0, 0.4
    instance, fields = start(pendulum()), control(tolerance, span, h=0.002)
    nothing, parts, sizes = np.empty(0), [], []
    for _ in range(20):
        time, error = instance.time, fields.error_sum
        instance.control_run(fields, None, span, 1, nothing, None, None, 0)
        tried = instance.time - time
        parts.append((fields.error_sum - error) * span / (tolerance * tried))
        sizes.append(fields.h / tried)
    checked = 0
    for last, part, ratio in zip(parts[1:], parts[2:], sizes[2:], strict=False):  # before, errors are round-off
        assert ratio == pytest.approx((aim / part) ** (0.7 * k) * (last / aim) ** (0.4 * k), rel=1e-6)
        checked += abs(math.log(last / part)) > 0.02  # where the two errors differ, their exponents can be told apart
    assert checked > 5


def test_a_step_ends_where_a_guide_has_a_break() -> None:
    """A driven coordinate whose acceleration jumps at 0.31 and 0.77 s."""
    b = SystemBuilder(np.array([[1.0]]), [0.0], rows=[Row(0.0, {0: 1.0}, guided=[(0, 1, -1, -1, -1.0)])])
    first, second, third = [0.0, 0.0, 1.0], [0.31**2, 0.62, 0.0], [0.31**2 + 0.62 * 0.46, 0.62, -1.0]
    pieces = [c for piece in (first, second, third) for c in (*piece, 0.0, 0.0, 0.0)]
    b.guides = [(DrivingFunctionType.OF_TIME, -1, [3.0, 0.0, 0.31, 0.77, 2.0, *pieces])]
    instance, fields, ends = start(b), control(1e-2, 1.0), []
    while instance.time < 1.0:
        instance.control_run(fields, None, 1.0, 1, np.empty(0), None, None, 0)
        ends.append(instance.time)
    assert 0.31 in ends
    assert 0.77 in ends
    assert ends[-1] == 1.0


def test_velocities_err_by_their_part_of_the_rate() -> None:
    """In a step from rest the error of the velocity over a rate of 5/s, or of 10/s, is more than that of the way."""
    errors = []
    for rate in (5.0, 10.0):
        fields = control(1.0, h=0.1, rate=rate)
        start_ = start(pendulum())
        start_.control_run(fields, None, 2.0, 1, np.empty(0), None, None, 0)
        errors.append(fields.error_sum)
    assert errors[0] == pytest.approx(2.0 * errors[1], rel=1e-9)


@pytest.mark.parametrize("method", ["ali3p", "radau_5", "runge_kutta_8"])
def test_the_record_of_a_smooth_motion_needs_no_further_steps(method: str) -> None:
    """The polynomial of a step agrees with the equations of motion between its ends."""
    instance, fields, times = start(pendulum(), METHODS[method]), control(1e-3), np.linspace(0.0, 2.0, 201)[1:]
    sensors, positions = run(instance, fields, times)
    assert fields.side_steps == 0
    np.testing.assert_allclose(sensors[:, :2], positions, rtol=0, atol=0)
    np.testing.assert_allclose(np.hypot(*positions.T), 1.0, rtol=0, atol=1e-4)


def test_the_record_is_that_of_steps_to_its_times() -> None:
    """With element states a step of the method goes to each time; the same to a state that starts there."""
    times = np.array([0.013, 0.017, 0.3, 0.4])
    sensors, positions = run(start(everything()), control(1e-5, 0.5), times, t_end=0.5)
    fine = start(everything())
    for t, values, q in zip(times, sensors, positions, strict=True):
        n = round((t - fine.time) / 1e-4)
        fine.run((t - fine.time) / n, n)
        assert np.abs(np.array(fine.get_state()[0]) - q).max() < 2e-5
        assert np.isfinite(values).all()


@pytest.mark.parametrize(
    "bad",
    [
        {"tolerance": 0.0},
        {"length": -1.0},
        {"span": math.inf},
        {"rate": 0.0},
        {"longest": 0.0},
        {"h": math.nan},
    ],
)
def test_bad_fields_are_refused_and_change_nothing(bad: dict[str, float]) -> None:
    instance = start(pendulum())
    before = instance.save()
    with pytest.raises(KernelError) as error:
        run(instance, control(**bad), np.array([2.0]))
    assert error.value.status == Status.BAD_ARGUMENT
    assert instance.save() == before
