"""Lanes have the bits of single runs: the whole saved state, with its counters, after every part of a run."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from mbs import Model, Pose, Settings, Simulation, System, compile, write_road
from mbs.elements import EndStops, GridRoad, KerbRoad, PlaneRoad
from mbs.kernel.binding import KernelError, Status
from mbs.kernel.binding.many import Many, widest_lanes
from mbs.scenes import (
    bicycle,
    bricard,
    double_four_bar,
    flyball,
    spatial_chain,
    spinning_beam,
)
from mbs.simulation.prepared_system import prepared
from tests.model.table_models import coupled
from tests.simulation.many_cars import CARS, attach, car
from tests.simulation.many_cars import system as car_system

# Two of the cars have springs with which no car works, so that their steps are halved and refused.
# A frame has no equilibrium on that spring.
FLEXIBLE = ["wild" if name == "stiff spring at a kerb" else name for name in CARS]
pytestmark = pytest.mark.filterwarnings("ignore:Parameter:mbs.ParameterWarning")

WIDTHS = [w for w in (2, 4, 8) if w <= widest_lanes()]
SCENES: dict[str, tuple[Callable[[], Model], float]] = {
    "Bricard": (bricard.build, 5e-3),
    "flyball": (flyball.build, 5e-3),
    "spatial chain": (spatial_chain.build, 5e-3),
    "bicycle": (bicycle.build, 5e-3),
    "spinning beam": (spinning_beam.build, 1e-2),
    "tables": (lambda: coupled(whole=False), 5e-3),
    "tables, whole": (lambda: coupled(whole=True), 5e-3),
}
DAMPED = 6  # first steps of flexible Systems, by another rule


def run_alone(simulation: Simulation, h: float, n: int) -> tuple[int, int]:
    """Steps done and the status."""
    steps = simulation.instance.report()["steps"]
    try:
        simulation.instance.run(h, n)
    except KernelError as error:
        return int(simulation.instance.report()["steps"] - steps), error.status
    return n, Status.OK


def compare(many: Many, single: list[Simulation], together: list[Simulation], h: float, n: int) -> tuple[int, set[int]]:
    """Steps that were made alone, and how the runs ended; asserts the bits."""
    nothing = [None] * len(together)
    ended = many.run([s.instance for s in together], h, n, n, nothing, nothing)
    for k, (one, other, end) in enumerate(zip(single, together, ended, strict=True)):
        status = Status.OK if end.error is None else end.error.status
        assert run_alone(one, h, n) == (end.done, status), k
        assert one.instance.save() == other.instance.save(), f"lane {k} after t = {one.time}"
    return sum(end.alone for end in ended), {0 if e.error is None else e.error.status for e in ended}


def _attached(names: list[str], settings: Settings, fidelity: int) -> tuple[list[Simulation], list[Simulation]]:
    """The cars of these names twice."""
    single, together = ([car(name, settings, fidelity) for name in names] for _ in range(2))
    for name, s in [*zip(names, single, strict=True), *zip(names, together, strict=True)]:
        attach(name, s)
    return single, together


@pytest.mark.slow
@pytest.mark.parametrize("width", WIDTHS)
def test_cars_have_the_bits_of_single_runs(width: int) -> None:
    """Wild driving, kerbs, a fall and a launch beside each other; steps are divided at abrupt forces, at 40 ms halved
    too, or refused without halves.

    The neighbours of a car that halves, fails or stands still go on with their bits.
    """
    cases = ((0.01, 0), (0.01, 8), (0.04, 8), (0.04, 0))
    alone, statuses = dict.fromkeys(cases, 0), set[int]()
    for h, halvings in cases:
        settings = Settings(max_halvings=halvings)
        for first in range(0, len(CARS), width):
            names = list(CARS)[first : first + width]
            single, together = _attached(names, settings, 0)
            many = Many(prepared(single[0].system)[0], width)
            for _ in range(4):
                part, ended = compare(many, single, together, h, 25)
                alone[h, halvings] += part
                statuses |= ended
    assert alone[0.01, 0] == 0  # a step that lanes get wrong is refused there and right alone
    assert alone[0.01, 8] > 0
    assert alone[0.04, 8] > 0
    assert statuses > {Status.OK}


@pytest.mark.parametrize("halvings", [0, 8])
def test_cars_by_table_have_the_bits_of_single_runs(halvings: int) -> None:
    """Each lane is in cells of its own of the tables; what is summed over the bodies of the chassis is of each lane."""
    alone, width = 0, WIDTHS[-1]
    for first in range(0, len(CARS), width):
        names = list(CARS)[first : first + width]
        single, together = _attached(names, Settings(max_halvings=halvings), 10)
        many = Many(prepared(single[0].system)[0], width)
        for _ in range(2):
            part, statuses = compare(many, single, together, 0.01, 30)
            assert statuses == {Status.OK}
            alone += part
    assert (alone > 0) == (halvings > 0)  # what is made alone is divided: lanes get no step wrong


@pytest.mark.slow
def test_flexible_cars_have_the_bits_of_single_runs() -> None:
    """Also beside cars whose steps are halved, or refused without halves; those and the first few are made alone."""
    halved, statuses, width = 0, set[int](), WIDTHS[-1]
    for h, halvings in ((0.01, 8), (0.04, 8), (0.04, 0)):
        for first in range(0, max(4, width), width):
            single, together = _attached(FLEXIBLE[first : first + width], Settings(max_halvings=halvings), 3)
            many = Many(prepared(single[0].system)[0], width)
            alone, ended = compare(many, single, together, h, 30)
            statuses |= ended
            reports = [s.instance.report() for s in single]
            result = int(sum(r["halvings"] + r["divisions"] for r in reports))
            halved += result
            if halvings > 0:
                assert alone <= DAMPED * len(single) + result
    assert halved > 0
    assert statuses > {Status.OK}


@pytest.mark.parametrize("fidelity", [0, 10])
def test_lanes_with_the_same_axes_of_wheels_advance_together(fidelity: int) -> None:
    """Those of the drawing or others; lanes with different ones make each step alone."""

    def cars(toes: list[float]) -> list[Simulation]:
        compiled, pose = car_system(fidelity) if fidelity else car_system(), Pose(speed=20.0)
        return [Simulation(compiled, parameters={"front.alignment.toe_left": toe}, pose=pose) for toe in toes]

    many = Many(prepared(cars([0.0])[0].system)[0], WIDTHS[0])
    ends = []
    for toes, alone in (([0.0, 0.0], 0), ([0.02, 0.02], 0), ([0.02, 0.03], 40), ([0.0, 0.02], 40), ([0.0, 0.0], 0)):
        together = cars(toes)
        assert compare(many, cars(toes), together, 0.005, 20) == (alone, {Status.OK})
        ends.append(together[0].sensors["wheel_FL.Fy"])
    assert ends[0] == ends[3] == ends[4]
    assert ends[1] == ends[2] != ends[0]


def test_lanes_have_roads_of_their_own(tmp_path: Path) -> None:
    """From files: a grid, which each lane asks alone, beside planes and a kerb, in any number of lanes."""
    heights = 0.02 * np.sin(np.arange(60.0 * 40.0)).reshape(60, 40)
    frictions = np.where(np.arange(60)[:, None] % 7 < 3, 0.3, 0.9) * np.ones(40)
    roads: dict[str, PlaneRoad | KerbRoad | GridRoad] = {
        "grid": GridRoad((-5.0, -10.0), (0.5, 0.5), heights, frictions),
        "slope": PlaneRoad(0.0, 0.05, -0.1, 0.6),
        "level": PlaneRoad(),
        "kerb": KerbRoad(4.0, 0.12, 0.0, "after"),
    }
    for name, road in roads.items():
        write_road(road, tmp_path / f"{name}.ali3road")
    for names in (
        ["slope", "level"],
        ["level", "kerb"],
        ["grid", "grid"],
        ["grid", "slope", "kerb", "grid"][: WIDTHS[-1]],
    ):
        single, together = ([_on(tmp_path / f"{name}.ali3road") for name in names] for _ in range(2))
        many = Many(prepared(single[0].system)[0], next(w for w in WIDTHS if w >= len(names)))
        assert compare(many, single, together, 0.005, 120) == (0, {Status.OK})  # wrong steps would be made alone
        assert len({s.instance.save() for s in together}) == len(set(names))
        del single[2:], together[2:]  # their roads too; lanes that look at them fail in `tests.sanitize`
        assert compare(many, single, together, 0.005, 5) == (0, {Status.OK})


def _on(file: Path) -> Simulation:
    inputs = {"steering": 0.4, "throttle": 0.6}
    settings = Settings(max_halvings=0)  # no step is divided
    pose = Pose(speed=10.0)
    return Simulation(car_system(), settings=settings, inputs=inputs, parameters={"road.file": str(file)}, pose=pose)


@pytest.mark.parametrize("name", SCENES)
def test_mechanisms_have_the_bits_of_single_runs(name: str) -> None:
    """Angle, guided and velocity rows too; the lanes are at different times of the motion."""
    build, h = SCENES[name]
    system = compile(build())
    single, together = ([_after(system, 7 * k, h) for k in range(WIDTHS[-1])] for _ in range(2))
    alone, statuses = compare(Many(prepared(system).loaded, WIDTHS[-1]), single, together, h, 60)
    assert (alone, statuses) == (DAMPED if len(system.arrays["flex_mode"]) > 0 else 0, {0})


def _after(system: System, steps: int, h: float) -> Simulation:
    simulation = Simulation(system)
    simulation.instance.run(h, steps)
    return simulation


@pytest.mark.parametrize(
    "settings",
    [Settings(update="paper"), Settings(method="ali3p_generalised_alpha"), Settings(step_iterations=2)],
    ids=["update (16)", "generalised-alpha", "limited steps"],
)
def test_what_is_not_for_lanes_is_stepped_alone(settings: Settings) -> None:
    compiled, h, n = compile(double_four_bar.build()), 0.005, 5
    single, together = ([Simulation(compiled, settings=settings) for _ in range(2)] for _ in range(2))
    assert compare(Many(prepared(compiled).loaded, 2), single, together, h, n)[0] == 2 * n


def test_lanes_count_abrupt_steps_at_a_stop_from_the_first_step_on() -> None:
    """A state in which a spring is beyond its stop goes on in lanes that have made no step of their own."""
    system, h, n = compile(_stopped()), 0.004, 5
    begun = _after(system, 10, h)
    single, together = ([Simulation(system) for _ in range(2)] for _ in range(2))
    for simulation in (*single, *together):
        simulation.restore(begun.save())
    counted = single[0].instance.report()["abrupt_steps"]
    assert compare(Many(prepared(system).loaded, 2), single, together, h, n) == (0, {Status.OK})
    assert single[0].instance.report()["abrupt_steps"] > counted


def _stopped() -> Model:
    """A mass that meets a stop after 0.03 s and is in it for half of a period of 0.1 s; there is no road."""
    m = Model("mass at a stop", dimension=2, gravity=(0.0, 0.0))
    mass = m.point_mass("mass", mass=1.0, position=(1.0, 0.0))
    m.point_on_line("line", (mass, (1.0, 0.0)), (m.ground, (1.0, 0.0)), axis=(1.0, 0.0))
    m.initial_velocity(mass, linear=(1.0, 0.0))
    stops = EndStops(rebound_length=1.03, rebound_stiffness=4e3)
    m.spring_damper("stop", (m.ground, (0.0, 0.0)), (mass, (1.0, 0.0)), stiffness=0.0, free_length=1.0, stops=stops)
    return m


def test_groups_refuse_instances_that_they_cannot_step() -> None:
    system = compile(double_four_bar.build())
    loaded, other = prepared(system).loaded, prepared(compile(double_four_bar.build(windows=2))).loaded
    one, two = Simulation(system), Simulation(system, settings=Settings(tolerance_r=1e-9))
    for width in (1, 3, 16, 2 * widest_lanes()):
        with pytest.raises(KernelError):
            Many(loaded, width)
    many, before = Many(loaded, 2), one.instance.save()
    for group in ([one, one], [one, two]):
        with pytest.raises(KernelError):
            many.run([s.instance for s in group], 0.01, 1, 1, [None, None], [None, None])
    with pytest.raises(KernelError):
        Many(other, 2).run([one.instance], 0.01, 1, 1, [None], [None])
    assert one.instance.save() == before
    assert np.isfinite(one.time)
