"""Groups of entries, each computed in one process."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from tests.bits import file_runs, fmu_runs
from tests.bits.kernel_runs import SCENES, analyses, scene_runs
from tests.bits.store import Entry

Entries = Iterator[tuple[str, Entry]]


@dataclass(frozen=True)
class Group:
    """Entries with common prefixes of their names."""

    make: Callable[[Path, Path], Entries]
    """Function of the folder of FMUs and a scratch folder that yields the entries."""
    begins: tuple[str, ...]
    """Prefixes of the names."""
    needs: tuple[str, ...] = ()
    """Cars whose FMUs are required."""


CARS = ("prototype", "hatchback")
TESTS = {
    "steady_circle": ("steady_circle.speed_rise=0.6",),
    "step_steer": ("step_steer.level_1=0", "step_steer.level_3=0"),
    "sine_steer": (),
    "chirp_steer": ("chirp_steer.duration=30",),
    "sine_with_dwell": ("sine_with_dwell.increment=1.5",),
    "double_lane_change": ("double_lane_change.course=2", "double_lane_change.resolution=5"),
    "straight_braking": (),
    "braking_in_a_turn": ("braking_in_a_turn.levels=2",),
    "kerb": (),
    "drop": (),
}
"""Tests of the catalogue, with settings that leave out runs of the same kind."""
OF_BOTH = ("straight_braking", "kerb", "drop")
FEW = ("pendulum", "double_four_bar", "arm", "planar", "gears", "roller", "triangle", "sledge_on_waves")
"""Mechanisms that together contain every joint, force and setting."""


def _groups() -> dict[str, Group]:
    others = tuple(name for name in SCENES if not name.startswith((*CARS, "kerb_test")))
    groups = {"few mechanisms": _runs(FEW), "mechanisms": _runs(tuple(s for s in others if s not in FEW))}
    groups |= {"kerb_test": _runs(tuple(s for s in SCENES if s.startswith("kerb_test")))}
    groups |= {f"{car} runs": _runs(tuple(s for s in SCENES if s.startswith(car))) for car in CARS}
    groups["analyses"] = Group(lambda fmus, scratch: analyses(), ("analysis/",))
    for car in CARS:
        begins = (f"drive/{car}/", f"fmu/{car}/")
        groups[f"{car} FMU"] = Group(partial(fmu_runs.car_runs, car), begins, (car,))
        groups[f"{car} page"] = Group(partial(file_runs.pages, car), (f"page/{car}/",), (car,))
        groups[f"{car} kinematics"] = Group(partial(file_runs.kinematics, car), (f"kinematics/{car}/",))
        for test in TESTS if car == "hatchback" else OF_BOTH:
            name = f"catalogue/{car}/{test}"
            groups[name] = Group(partial(file_runs.catalogue, car, test, TESTS[test]), (name,), (car,))
    groups["study"] = Group(file_runs.studies, ("study/",), ("hatchback",))
    groups["compare"] = Group(file_runs.comparison, ("compare/",), ("hatchback",))
    groups["roads"] = Group(file_runs.roads, ("road/",))
    return groups


def _runs(scenes: tuple[str, ...]) -> Group:
    def make(fmus: Path, scratch: Path) -> Entries:
        for name in scenes:
            yield from scene_runs(name)

    return Group(make, tuple(f"run/{name}/" for name in scenes))


GROUPS = _groups()


def group_of(entry: str) -> str:
    """The group of an entry, "" if there is none."""
    return next((name for name, group in GROUPS.items() if entry.startswith(group.begins)), "")
