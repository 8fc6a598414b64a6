"""Choice of a method: candidates by properties of the System, then the fastest in coarse runs."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from mbs.kernel.binding import KernelError, Status
from mbs.kernel.header.enumerations import DrivingFunctionType
from mbs.kernel.header.limits import MOST_PARTS
from mbs.results.simulation_error import SimulationError
from mbs.settings.methods import METHOD_TABLE
from mbs.settings.settings import Settings
from mbs.simulation.controlled_run import ControlledRun, StalledError, Task
from mbs.simulation.prepared_system import prepared
from mbs.simulation.stepped_system import SteppedSystem
from mbs.system.system import System

COARSE = 1e-3  # tolerance from which methods of low order are candidates: ALi3-P for stiff Systems, order four in trees
FEWEST = 10  # least steps of a call, which itself costs as much as a few evaluations
LAST = ("radau_5", "runge_kutta_8", "ali3p")  # tried last


@dataclass(frozen=True)
class MethodChoice:
    """Chosen method, the reason, its coarse run, and methods that are tried if it does not keep the tolerance."""

    method: str
    reason: str
    run: ControlledRun | None
    wall: float
    runs: int
    others: tuple[str, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """The method and those that are tried after it."""
        return self.method, *self.others


def candidates(system: System, tolerance: float) -> tuple[list[str], str]:
    """Methods that may be the fastest for a System, and the property that excludes the others."""
    if len(system.arrays["y0"]) > 0:
        return ["ali3p"], "elements with states"
    if np.any(system.arrays["guide_type"] != DrivingFunctionType.OF_TIME):
        return ["ali3p"], "driving functions through a filter"
    coarse = ["ali3p"] if tolerance >= COARSE else []
    if not prepared(system).meta["report"]["no_tree"]:
        return ["semi_recursive_4" if coarse else "semi_recursive", "radau_5", *coarse], "a tree of joints"
    if len(system.arrays["velocity_row"]) > 0:
        return ["runge_kutta_8", *coarse], "wheels that roll"
    return ["runge_kutta_8", "radau_5", *coarse], "no tree of joints"


def choose(
    start: Callable[[], SteppedSystem], task: Task, settings: Settings, tolerance: float, coarse: float
) -> MethodChoice:
    """Choose the method for a tolerance by runs of all candidates at the tolerance `coarse`.

    Each runs while its weighted work is the least. Raises `SimulationError` if none reaches the end.
    """
    system = start().system
    names, property_text = candidates(system, tolerance)
    if len(names) == 1:
        return MethodChoice(
            names[0], f"chosen: {property_text}", None, 0.0, 0, tuple(name for name in LAST if name != names[0])
        )
    growth = coarse / tolerance
    runs = {name: ControlledRun(start(), task, replace(settings, method=name), coarse) for name in names}
    methods = {name: METHOD_TABLE[name] for name in names}
    weights = {name: m.cost * growth ** (1.0 / m.order_of_changing_steps) for name, m in methods.items()}
    best, failed = _first_to_end(runs, weights)
    wall = sum(run.wall for run in runs.values())
    if not best:
        raise SimulationError(
            f"None of {', '.join(runs)} reaches the end of the run from t = {task.t0:g} to {task.t_end:g} s, not even "
            f"at {coarse:g} instead of the tolerance of {tolerance:g} requested; name a method to see where and "
            "why it fails.",
            task.t0,
            Status.NOT_CONVERGED,
        )
    rejections = [f"{name} {'fails' if name in failed else 'is slower'}" for name in runs if name != best]
    others = tuple(name for name in dict.fromkeys([*runs, *LAST]) if name != best and name not in failed)
    return MethodChoice(
        best, f"chosen in coarse runs: {property_text}, {', '.join(rejections)}", runs[best], wall, len(runs), others
    )


def _first_to_end(runs: dict[str, ControlledRun], weights: dict[str, float]) -> tuple[str, set[str]]:
    """Advance the run of least weighted work until that has ended; return its name, or "", and those that failed.

    `weights`: factors of the work of the coarse runs, which give the work of runs to the tolerance.
    """
    failed = set[str]()
    while running := [name for name in runs if name not in failed]:
        name = min(running, key=lambda n: runs[n].work * weights[n])
        if runs[name].finished:
            return name, failed
        try:
            runs[name].advance(FEWEST + runs[name].fields.accepted // MOST_PARTS)
        except (KernelError, StalledError):
            failed.add(name)
    return "", failed
