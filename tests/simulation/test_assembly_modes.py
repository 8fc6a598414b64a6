"""A closed loop that changes its assembly mode is reported; one that passes a singular position smoothly is not."""

import re
import warnings
from contextlib import suppress
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import mbs
from mbs import BranchWarning, Model, Settings, Simulation, SimulationError, System, compile
from mbs.compiler import assembly_modes
from mbs.compiler.loop_motion import trace
from mbs.kernel.binding import KernelError, LoadedSystem, Status
from mbs.scenes import (
    assembly_defect_four_bar,
    bricard,
    double_four_bar,
    prototype_car,
    spatial_slider_crank,
)
from mbs.simulation.unstepped_system import StandingSystem

from .loops import four_bar, suspension

# one flexible body a bar bends too far, as warned: here branches count
pytestmark = pytest.mark.filterwarnings("ignore::mbs.simulation.large_bending.BendingWarning")
simulate = partial(mbs.simulate, estimate_error=False)  # what the step costs is not asked here
GRASHOF = (0.4, 0.1, 0.35, 0.3)  # m: the crank turns round, the rocker keeps its side


def without_modes(system: System) -> System:
    """The same System, which knows nothing of its loops."""
    arrays = {n: v for n, v in system.arrays.items() if not n.startswith("mode_")}
    return System(arrays, system.meta)


@pytest.fixture(scope="module")
def defect() -> System:
    return compile(assembly_defect_four_bar.build(1))


@pytest.fixture(scope="module")
def thrown() -> System:
    """A suspension whose upright starts upwards fast enough to turn about its ball joints."""
    return compile(suspension(15.0))


def test_modes_are_traced_once_and_for_steps_only(monkeypatch: pytest.MonkeyPatch) -> None:
    traced = []
    monkeypatch.setattr(assembly_modes, "trace", lambda *given: traced.append(given) or trace(*given))
    model = suspension(15.0)
    system = compile(model)
    StandingSystem(system)
    assert not traced
    model.body("added later", mass=1.0, com=(0.0, 0.0, 0.0), inertia=(1.0, 1.0, 1.0))
    whole = system.to_bytes()
    Simulation(system)
    assert len(traced) == 1
    assert whole == compile(suspension(15.0)).to_bytes() != without_modes(system).to_bytes()


def test_a_suspension_that_turns_inside_out_is_reported_by_name_and_time(thrown: System) -> None:
    run = simulate(thrown, 0.3, 5e-4)  # no warning: the motion does it, not the steps
    assert re.search(r"'lower ball', 'upper ball', 'tie rod'.*at 'tie rod'", run.branch_change)
    assert run.branch_change in str(run)
    assert run.report is not None
    assert (run.report.branch_changes, run.report.branch_kind) == (1, 1)
    # the track rod lies in the plane of the kingpin at 0.09 s, reported once its sine is 0.15 beyond
    assert run.report.branch_time == pytest.approx(0.093, abs=0.002)
    assert f"{run.report.branch_time:.6g} s" in run.branch_change


def test_a_suspension_that_comes_back_is_not_reported() -> None:
    run = simulate(compile(suspension(5.0)), 0.3, 5e-4)
    assert run["wheel.z"].max() > 0.48  # of 0.53 where the wishbones lock
    assert run.report is not None
    assert run.report.branch_changes == 0


def test_the_mode_is_left_at_the_same_time_with_other_steps_and_methods(thrown: System) -> None:
    for method, h in (("ali3p", 2e-3), ("energy_momentum", 2.5e-4), ("radau_5", 2e-3)):
        run = simulate(thrown, 0.15, h, method=method)
        assert "'tie rod'" in run.branch_change
        assert run.report is not None
        assert run.report.branch_time == pytest.approx(0.093, abs=0.003)


def test_a_loop_without_springs_swings_as_it_likes() -> None:
    run = simulate(compile(suspension(15.0, sprung=False)), 0.3, 5e-4)
    assert run.report is not None
    assert run.report.branch_changes == 0


def test_a_step_that_jumps_the_branch_is_reported(defect: System) -> None:
    with pytest.warns(BranchWarning, match=r"t = 1\.6 s the closed loop of 'B', 'C' .*take a shorter one"):
        run = simulate(defect, 2.5, 0.05)
    assert run["coupler.My"].min() < -11.0  # -9.1 on the branch of short steps
    assert run.report is not None
    assert run.report.branch_kind == 2


def test_short_steps_stay_on_the_branch(defect: System) -> None:
    run = simulate(defect, 10.0, 0.02)
    assert run["coupler.My"].min() == pytest.approx(-9.1, abs=0.1)
    assert run.report is not None
    assert run.report.branch_changes == 0


@pytest.mark.parametrize(("scene", "h"), [(double_four_bar, 0.03), (bricard, 0.01), (spatial_slider_crank, 0.01)])
def test_singular_positions_on_the_smooth_branch_are_no_alarm(scene, h: float) -> None:
    run = simulate(compile(scene.build()), 10.0, h)
    assert run.report is not None
    assert run.report.branch_changes == 0


@pytest.mark.parametrize(
    ("lengths", "side"),
    [(GRASHOF, 1), ((0.4, 0.2, 0.4, 0.2), -1), ((0.2, 0.25, 0.25, 0.35), 1), ((0.3, 0.2, 0.25, 0.2), -1)],
)
def test_four_bars_of_all_kinds_are_no_alarm(lengths: tuple[float, float, float, float], side: int) -> None:
    run = simulate(compile(four_bar(lengths, 1.0, side, 6.0)), 5.0, 0.005)
    assert run.report is not None
    assert run.report.branch_changes == 0


def test_two_bodies_and_the_ground_are_a_loop() -> None:
    """A slider-crank whose rod slides with a point: in a turn both signs of sine and cosine of its angle occur."""
    m = Model("slider-crank", dimension=2)
    crank = m.body("crank", mass=1.0, com=(0.0, 0.05), inertia=0.01)
    rod = m.body("rod", mass=1.0, com=(0.1, 0.05), inertia=0.02)
    m.revolute("A", m.ground, crank, point=(0.0, 0.0))
    m.revolute("B", crank, rod, point=(0.0, 0.1))
    m.point_on_line("C", (rod, (0.2, 0.0)), (m.ground, (0.0, 0.0)), axis=(1.0, 0.0))
    arrays = compile(m).arrays
    assert bytes(arrays["mode_name"].tolist()) == b"B"
    assert {cell for cell, mask in zip(*[iter(arrays["mode_cell"])] * 2, strict=True) if mask == 3} == {0, 1, 2, 3}


def test_a_step_onto_the_other_circuit_is_reported() -> None:
    """At 20 rad/s the crank turns radians in a step, and the rocker lands on the side that no motion reaches."""
    system = compile(four_bar((0.4, 0.1, 0.4, 0.15), 1.0, 1, 20.0))
    changes = []
    for method in ("ali3p_no_projection", "energy_momentum", "radau_5"):
        for h in (0.05, 0.1, 0.15, 0.2):
            simulation = Simulation(system, settings=Settings(method=method, max_halvings=0))
            with suppress(SimulationError):
                simulation.step(h, 10)
            changes += [simulation.branch_change] if simulation.report.branch_kind == 1 else []
    assert len(changes) >= 3
    assert all("the closed loop of 'B', 'C' left its assembly mode at 'C'" in text for text in changes)
    assert simulate(system, 0.4, 0.001, method="radau_5").report.branch_changes == 0  # type: ignore[union-attr]


def test_the_status_sensor_reports_it_from_then_on() -> None:
    m = suspension(15.0)
    m.sense_solver("solver.status", "status")
    run = simulate(compile(m), 0.15, 5e-4)
    assert run.report is not None
    after = run.t >= run.report.branch_time - 1e-9
    assert np.all(run["solver.status"][after] == Status.BRANCH_CHANGED)
    assert np.all(run["solver.status"][~after] == 0.0)


@pytest.mark.filterwarnings("ignore::mbs.results.accuracy.AccuracyWarning")  # steps long for what they show
def test_the_first_change_is_the_one_that_is_reported(thrown: System) -> None:
    """It comes back and turns over again: the count goes on, loop, triad and time are those of the first."""
    simulation, changes = Simulation(thrown), {}
    for _ in range(250):
        simulation.step(2e-3)
        report = simulation.report
        changes.setdefault(report.branch_changes, (simulation.branch_change, report.branch_time))
    assert max(changes) >= 2
    assert changes[1] == changes[2]
    assert changes[1][1] == pytest.approx(0.094)


def test_watching_changes_no_bit(defect: System) -> None:
    for system, t_end, h in ((defect, 3.0, 0.05), (compile(double_four_bar.build()), 5.0, 0.01)):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", BranchWarning)
            seen, unseen = (simulate(s, t_end, h) for s in (system, without_modes(system)))
        assert all(np.array_equal(seen[name], unseen[name]) for name in unseen)
        assert seen.report is not None
        assert unseen.report is not None
        assert replace(seen.report, branch_changes=0, branch_time=0.0, branch_kind=0) == unseen.report


def test_what_a_step_leaves_behind_is_that_of_the_whole_step(defect: System) -> None:
    """The step of the jump is made again in parts; the tangent that readers find is the one of the step itself."""
    pair = [Simulation(s) for s in (defect, without_modes(defect))]
    for _ in range(34):
        for simulation in pair:
            simulation.step(0.05)
    assert pair[0].report.branch_changes == 1
    assert pair[0].instance.tangent(0.05)[:] == pair[1].instance.tangent(0.05)[:]
    assert pair[0].sensors == pair[1].sensors


def test_a_restored_state_continues_its_count(thrown: System) -> None:
    first, second = Simulation(thrown), Simulation(thrown)
    first.step(5e-4, 170)
    state = first.save()
    second.restore(state)
    for simulation in (first, second):
        simulation.step(5e-4, 100)
    assert first.branch_change == second.branch_change != ""
    third = Simulation(thrown)
    third.restore(first.save())
    assert third.branch_change == first.branch_change
    third.step(5e-4, 10)
    assert third.report.branch_changes == first.report.branch_changes


def test_the_loops_of_the_car_are_known() -> None:
    system = compile(prototype_car.build())
    assert len(system.arrays["mode_cell_ptr"]) == 5  # a loop at each wheel
    assert np.diff(system.arrays["mode_cell_ptr"]).tolist() == [2, 2, 2, 2]


@pytest.mark.parametrize(
    ("name", "place", "value"),
    [("mode_triad", 0, 10_000), ("mode_triad", 9, 4), ("mode_triad", 10, 3), ("mode_cell", 0, -1), ("mode_name", 0, 0)]
    + [(f"mode_{n}_ptr", 1, 10_000) for n in ("triad", "cell", "name")],
)
def test_the_kernel_refuses_altered_modes(thrown: System, name: str, place: int, value: int) -> None:
    values = np.array(thrown.arrays[name])
    values[place] = value
    with pytest.raises(KernelError, match=name):
        LoadedSystem(System({**thrown.arrays, name: values}, thrown.meta).to_bytes())


@pytest.mark.parametrize(("method", "h"), [("ali3p", 0.03), ("energy_momentum", 0.01)])
def test_a_run_without_output_ends_as_one_with_output(method: str, h: float) -> None:
    """Past singular positions steps are repeated in parts; their ends then come back in two ways."""
    system, steps = compile(double_four_bar.build()), round(3.0 / h)
    read, unread = (Simulation(system, settings=Settings(method=method)) for _ in range(2))
    for _ in range(steps):
        read.instance.step(h)
    unread.instance.run(h, steps)
    for name in ("q", "qd", "qdd", "lam", "y"):
        np.testing.assert_array_equal(getattr(read.state, name), getattr(unread.state, name))
    counts = [
        {k: v for k, v in s.instance.report().items() if not k.startswith("free_") and k != "kinetic_peak"}
        for s in (read, unread)
    ]
    assert counts[0] == counts[1]  # but for the trend of the energy, which is that of the states that are read
