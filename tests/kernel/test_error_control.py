"""Controlled runs of the kernel: what a call leaves behind, where steps end, and that parts of a run are the run."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbs.kernel.binding import ControlFields, Instance, KernelError, LoadedSystem, Status
from mbs.methods import METHOD_TABLE

from .scenes import everything, four_bar, pendulum
from .system_builder import SystemBuilder

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
    found = []
    for most in (1, 3, 10**6):
        instance, fields = start(four_bar(), METHODS[method]), control()
        found.append((*run(instance, fields, times, most), np.frombuffer(instance.save(), np.uint8)))
        assert instance.time == 2.0
    for other in found[1:]:
        for one, same in zip(found[0], other, strict=True):
            assert one.tobytes() == same.tobytes()


@pytest.mark.parametrize(
    ("method", "order", "loose", "tight"),
    [
        ("ali3p", 2, 1e-2, 1e-4),
        ("energy_momentum", 2, 1e-2, 1e-4),
        ("radau_5", 5, 1e-3, 1e-7),
        ("runge_kutta_8", 8, 1e-5, 1e-10),
    ],
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
    [
        ("ali3p", 1e-4),
        ("energy_momentum", 1e-4),
        ("energy_momentum_4", 1e-4),
        ("radau_5", 1e-6),
        ("runge_kutta_8", 1e-10),
    ],
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


def test_the_report_counts_accepted_halves_only() -> None:
    instance, fields = start(four_bar()), control(1e-3, h=0.5)  # much too long: rejected at first
    run(instance, fields, np.array([2.0]))
    assert fields.rejected + fields.failed > 0
    assert instance.report()["steps"] == 2 * fields.accepted


def test_the_record_is_what_steps_to_its_times_would_show() -> None:
    """With element states a step of the method goes to each time; the same to a state that starts there."""
    times = np.array([0.013, 0.017, 0.3, 0.4])
    sensors, positions = run(start(everything()), control(1e-5, 0.5), times, t_end=0.5)
    fine = start(everything())
    for t, values, q in zip(times, sensors, positions, strict=True):
        n = round((t - fine.time) / 1e-4)
        fine.run((t - fine.time) / n, n)
        assert np.abs(np.array(fine.get_state()[0]) - q).max() < 2e-5
        assert np.isfinite(values).all()


def test_nothing_is_left_of_a_record() -> None:
    """Looking between the steps does not change the motion."""
    ends = []
    for times in (np.array([2.0]), np.linspace(0.0, 2.0, 301)[1:]):
        instance = start(four_bar(), METHODS["radau_5"])
        run(instance, control(), times)
        ends.append([np.array(part).tobytes() for part in instance.get_state()])
    assert ends[0] == ends[1]


@pytest.mark.parametrize(
    "bad",
    [
        {"tolerance": 0.0},
        {"tolerance": math.nan},
        {"length": -1.0},
        {"span": math.inf},
        {"rate": 0.0},
        {"longest": 0.0},
        {"h": -1.0},
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


def test_a_run_before_the_start_is_refused() -> None:
    instance = Instance(LoadedSystem(pendulum().to_bytes()))
    with pytest.raises(KernelError) as error:
        run(instance, control(), np.array([2.0]))
    assert error.value.status == Status.NOT_INITIALISED
