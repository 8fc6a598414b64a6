"""Steps with limited Newton iterations: bounded work, a valid state, and a reported residual."""

from dataclasses import replace

import numpy as np
import pytest

import mbs
from mbs.elements import GridRoad
from mbs.kernel.binding import KernelError, LoadedSystem, Status
from mbs.kernel.binding.instance import Instance
from mbs.scenes import cart_pole, double_four_bar, prototype_car
from mbs.settings.settings import LIMITED, Settings

H = 0.005
DEEP = 30
SWEEPS = 3  # of a projection, at most


@pytest.fixture(scope="module")
def rough():
    """Kerbs of 0.1 m and holes on the way of a car at 15 m/s."""
    heights = np.zeros((200, 40))
    for k, i in enumerate(range(20, 200, 9)):
        heights[i : i + 4, (k % 3) * 8 : (k % 3) * 8 + 24] = 0.1 if k % 2 else -0.1
    road = GridRoad((-5.0, -10.0), (0.5, 0.5), heights)
    return LoadedSystem(mbs.compile(prototype_car.build(road=road)).to_bytes())


def started(loaded, **settings):
    instance = Instance(loaded)
    instance.set_settings(**settings)
    instance.set_pose(0.0, 0.0, 0.3, 0.0, 15.0)
    instance.initialise()
    return instance


def stepped(instance, steps, h=H):
    """Iterations of each step."""
    iterations = [instance.report()["iterations"]]
    for _ in range(steps):
        instance.run(h, 1)
        iterations.append(instance.report()["iterations"])
    return np.diff(iterations)


def test_a_limit_that_is_not_reached_changes_nothing_but_the_iterations_of_divided_steps(rough):
    """Without a limit, steps that turn out to be divided at an abrupt force end after one iteration."""
    free, limited = started(rough), started(rough, step_iterations=DEEP)
    assert stepped(free, 400).max() <= DEEP
    stepped(limited, 400)
    assert free.report()["halvings"] == 0
    assert free.report()["divisions"] == limited.report()["divisions"] > 0
    assert free.report()["iterations"] < limited.report()["iterations"]
    assert list(map(list, free.get_state())) == list(map(list, limited.get_state()))
    assert limited.report()["capped"] == 0
    assert limited.report()["capped_residual"] == 0.0


def test_all_parts_of_a_step_share_its_limit(rough):
    """Steps for whose halves it has no room stay whole."""
    free, limited, low = (started(rough, step_iterations=limit) for limit in (0, 12, 3))
    assert stepped(free, 400).max() > 12 >= stepped(limited, 400).max()
    stepped(low, 400)
    divisions = [instance.report()["divisions"] for instance in (low, limited, free)]
    assert 0 == divisions[0] < divisions[1] < divisions[2]
    assert limited.report()["failures"] == 0


@pytest.mark.parametrize("limit", [2, 5])
def test_no_step_exceeds_the_limit_of_iterations_or_fails(rough, limit):
    instance = started(rough, step_iterations=limit)
    result = stepped(instance, 600)
    report = instance.report()
    assert result.max() == limit
    assert report["failures"] == report["halvings"] == 0
    assert report["capped"] > 0
    assert 0.0 < report["capped_residual"] < 0.05
    assert np.isfinite(instance.get_state()[0]).all()


def test_steps_that_stay_whole_for_the_limit_are_counted(rough):
    """Without divisions only those count whose iterations it stops."""
    limited, whole = (started(rough, step_iterations=8, max_halvings=n) for n in (8, 0))
    stepped(limited, 400)
    stepped(whole, 400)
    assert limited.report()["capped"] > whole.report()["capped"]


@pytest.mark.parametrize("limit", [1, 5])
def test_the_work_of_a_step_is_bounded(rough, limit):
    """Factorizations are at most iterations, and solves are those and the sweeps of the two projections."""
    instance = started(rough, step_iterations=limit)
    names = ("iterations", "factorizations", "solves")
    before, most = instance.report(), dict.fromkeys(names, 0)
    for _ in range(400):
        instance.run(H, 1)
        after = instance.report()
        result = {name: after[name] - before[name] for name in names}
        assert result["factorizations"] <= result["iterations"] <= limit
        assert result["solves"] <= limit + 2 * SWEEPS
        most = {name: max(most[name], result[name]) for name in names}
        before = after
    assert most["iterations"] == limit
    assert most["solves"] > limit


def test_what_is_left_bounds_how_far_the_positions_are_off(rough):
    """One step from the same state, solved and not: the tangent holds more than the mass matrix alone."""
    exact, apart = started(rough, max_halvings=0), 0  # so small a limit leaves no room for halves
    for _ in range(300):
        limited = started(rough, step_iterations=2)
        limited.restore(exact.save())
        limited.set_settings(step_iterations=2)
        before = limited.report()["capped_residual"]
        limited.run(H, 1)
        exact.run(H, 1)
        off = np.abs(np.array(limited.get_state()[0]) - np.array(exact.get_state()[0])).max()
        residual = limited.report()["capped_residual"]
        if residual > max(before, 1e-6):
            apart += 1
            assert off < 1.5 * residual
    assert apart > 10


def test_a_saved_state_continues_bit_for_bit(rough):
    first = started(rough, step_iterations=3)
    stepped(first, 100)
    second = Instance(rough)
    second.restore(first.save())
    stepped(first, 100)
    stepped(second, 100)
    assert first.save() == second.save()
    assert first.report() == second.report()


def test_iterates_that_diverge_are_refused():
    loaded = LoadedSystem(mbs.compile(double_four_bar.build()).to_bytes())
    instance = Instance(loaded)
    instance.set_settings(step_iterations=1)
    instance.initialise()
    before = list(map(list, instance.get_state()))
    with pytest.raises(KernelError) as refused:
        instance.run(2.0, 1)
    assert refused.value.status in (Status.NOT_CONVERGED, Status.SINGULAR, Status.NOT_FINITE)
    assert list(map(list, instance.get_state())) == before
    assert instance.report()["capped"] == 0


@pytest.mark.parametrize("method", sorted({"energy_momentum", "runge_kutta_8", "radau_5", "semi_recursive"}))
def test_other_methods_have_no_such_limit(rough, method):
    with pytest.raises(ValueError, match=f"'step_iterations' is 5 with the method '{method}'; only 'ali3p'"):
        Settings(method=method, step_iterations=5)
    assert method not in LIMITED
    fields = Settings(method=method).kernel_fields() | {"step_iterations": 5}
    with pytest.raises(KernelError):
        Instance(rough).set_settings(**fields)


def test_a_run_reports_capped_steps(rough):
    system = mbs.compile(double_four_bar.build())
    run = mbs.simulate(system, 2.0, 0.02, settings=Settings(step_iterations=1), estimate_error=False)
    text = f"{run.report.capped} of 100 steps ended at the limit of their iterations, or stayed whole for it; they left"
    assert run.report.capped > 0
    assert text in repr(run)
    assert text in str(run.report)
    with pytest.raises(ValueError, match="step_iterations = 2 with a tolerance"):
        mbs.simulate(system, 2.0, tolerance=1e-3, settings=Settings(step_iterations=2))
    free = mbs.simulate(system, 2.0, 0.02, settings=replace(Settings(), step_iterations=0), estimate_error=False)
    assert "limit" not in repr(free)


def test_a_step_that_breaks_the_energy_balance_is_counted_too():
    """Without a limit it is refused; the report goes on to say how much energy is wrong."""
    simulation = mbs.Simulation(mbs.compile(cart_pole.build()), settings=Settings(step_iterations=30))
    with pytest.warns(mbs.AccuracyWarning):
        simulation.run(0.6, 1e-4, progress=False)
    assert simulation.report.capped > 0
    assert simulation.report.halvings == 0
    assert simulation.report.energy_balance > 0.01


def test_parts_of_a_step_that_only_look_at_branches_are_not_made():
    """Near a dead centre a step is repeated in parts, to see whether it jumped; where work is limited it is not."""
    loaded = LoadedSystem(mbs.compile(double_four_bar.build()).to_bytes())
    free, limited = Instance(loaded), Instance(loaded)
    free.initialise()
    result = stepped(free, 100, 0.02)
    assert free.report()["halvings"] == 0
    limited.set_settings(step_iterations=int(result.max()))
    limited.initialise()
    stepped(limited, 100, 0.02)
    assert list(map(list, limited.get_state())) == list(map(list, free.get_state()))
    assert limited.report()["capped"] == 0
