"""What a run with fixed steps finds about its own error: from the energy balance at no cost, and for suspect runs from
a refined run with shorter steps.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ali3.message_text import unit_text
from mbs.kernel.header.enumerations import GuideType
from mbs.kernel.header.limits import AGREED, MOST_PARTS, RESOLVED, WRONG_ERROR
from mbs.kernel.header.steps import Balance
from mbs.results.comparison import COORDINATES, INSTANTS, Compared
from mbs.results.run_report import Report
from mbs.results.smooth_laws import is_open_tree
from mbs.settings.methods import METHOD_TABLE
from mbs.system.system import System

OTHER_STEPS, OTHER_METHOD = "shorter steps keep it better", "method='energy_momentum' keeps it better"
# Of refined runs, in runs, unless `estimate_error` is a number: 4 + 8 + 16 + 32 where all steps were halved.
MOST_COST = float(MOST_PARTS * MOST_PARTS)
GOAL_ERROR = AGREED * WRONG_ERROR  # what a step that is tried as a remedy aims at, and what energy may be off by
CLEAR = 0.03  # of the range: a run that by order one is off by so little is right, and its step may be named
RIGHT = "A refined run, in which they do not, shows that what is compared is right all the same."
COARSER, FINER = "coarser", "finer"


class AccuracyWarning(UserWarning):
    """The result of a run is not what was asked for: its energy balance or a refined run say so."""


@dataclass(frozen=True)
class Accuracy:
    """Estimated error of a run."""

    energy_balance: float | None
    """Work that constraint forces and projections did, over the energy that was in the motion; they should do none.
    None where the method measures none (see `Report.energy_error`)."""
    energy_error: float | None
    """That work, J."""
    halvings_per_step: float
    """How often steps were halved."""
    compared_step: float | None = None
    """Step of the last refined run, s; None where there was none. Above that of the run it was a coarser one."""
    check_cost: float = 0.0
    """Steps of all refined runs over those of the run: what the check cost."""
    order: float | None = None
    """With which errors fall, as the energy of the two runs shows, else that of the method."""
    units: dict[str, float] = field(default_factory=dict)
    """Estimated largest error over the largest range, per unit that was judged ("1": coordinates of the System)."""
    sensors: dict[str, float] = field(default_factory=dict)
    """Estimated largest error of the sensors that were compared, in their units."""
    message: str = ""
    """Evidence against the result, with a remedy; empty where there is none."""
    notice: str = ""
    """A sentence about an open energy balance of a run that is right as its refined run shows; else empty."""
    branch: str = ""
    """A sentence about a change of the assembly mode that the refined run does not make; empty where there is none."""

    @property
    def error(self) -> float | None:
        """Largest of `units`; None where no refined run estimated one."""
        return max(self.units.values(), default=0.0) if self.compared_step is not None and self.units else None

    def __str__(self) -> str:
        sentences = []
        if self.energy_balance is not None:
            sentences.append(f"energy balance open by {_percent(self.energy_balance)}")
        if self.halvings_per_step > 0.0:
            sentences.append(f"{self.halvings_per_step:.2g} halvings a step")
        if self.units:
            errors = (f"{_percent(e)}{_of(unit)}" for unit, e in self.units.items())
            sentences.append(f"estimated error {', '.join(errors)}")
        if self.check_cost > 0.0:
            sentences.append(
                f"checked by runs of {self.check_cost:.2g} times its steps (at most {MOST_COST:g} unless "
                "estimate_error=N; none with estimate_error=False)"
            )
        return "; ".join(sentences)


def doubt(report: Report, method: str) -> str:
    """How a run is to be checked: empty, not at all; `COARSER` by one of twice the step, `FINER` by one of half.

    An open balance, and a loop that left its mode, are signs of coarse steps already; so is an energy that alone makes
    places wrong by a method of high order, past a singular position, where longer steps may gain as much by chance.
    """
    drifts = METHOD_TABLE[method].order > 2 and drift(report) > WRONG_ERROR
    if report.balance != Balance.KEPT or report.branch_changes > 0 or drifts:
        return FINER
    # what an abrupt force does is missed, or hidden in parts of steps
    whole = report.halvings == report.divisions == report.abrupt_steps == 0
    conserved = max(drift(report), abs(report.energy_change)) <= GOAL_ERROR
    return "" if summed_miss(report) <= WRONG_ERROR and conserved and whole else COARSER


def summed_miss(report: Report) -> float:
    """Changes of velocity that ``v + h a`` does not see, over the largest velocity."""
    # what a vehicle has at constant speed is no motion that steps could miss
    speed = min(report.speed_peak, report.velocity_path) or math.inf
    return report.predictor_path / speed


def drift(report: Report) -> float:
    """Energy balance times (1 + radians that the motion has turned): what a wrong energy does to the place adds up."""
    balance = report.energy_balance if abs(report.energy_error) > report.energy_floor else 0.0
    turned = report.velocity_path / report.speed_peak if report.speed_peak > 0.0 else 0.0
    return balance * (1.0 + turned)


def missed_share(report: Report, method: str) -> float:
    """Changes of velocity that ``v + h a`` does not see, over all: ``h w/2`` of a vibration or an impact of w.

    Long steps of order above two have few of an event among many smooth ones: of their squares the event keeps its
    share.
    """
    missed, all_of_them = report.predictor_path, report.velocity_path
    if METHOD_TABLE[method].order > 2:
        missed, all_of_them = math.sqrt(report.predictor_squares), math.sqrt(report.velocity_squares)
    return missed / all_of_them if all_of_them > 0.0 else 0.0


def divisor(steps: int, halvings: int) -> int:
    """By what the step is divided for the refined run: twice as fine as the steps that were really made."""
    return max(2, math.ceil(2.0 * (1.0 + halvings / max(steps, 1)) - 1e-9))


def recorded_every(every: int, steps: int) -> int:
    """A divisor of `every` with which a run of so many steps has enough samples to be compared."""
    least = max(1, steps // INSTANTS)
    return next(k for k in range(min(every, least), 0, -1) if every % k == 0) if isinstance(every, int) else every


def free_part(report: Report, steps: int, halvings: int) -> Accuracy:
    """Accuracy of a run from its energy balance alone, without a refined run."""
    moves = report.kinetic_peak > 0.0
    return Accuracy(
        report.energy_balance if moves else None,
        report.energy_error if moves else None,
        halvings / max(steps, 1),
    )


def balance_text(report: Report) -> str:
    """The energy balance in a sentence; empty where it does not say that the run is wrong."""
    if report.balance != Balance.WRONG:
        return ""
    return (
        f"Constraint forces and projections did {report.energy_error:.3g} J of work, {_percent(report.energy_balance)} "
        f"of the {report.energy_size:.3g} J in the motion; they should do none."
    )


def energy_text(report: Report, system: System, method: str) -> str:
    """That the energy of a free System does not stay, with a remedy; empty where it does."""
    share = report.energy_change
    if abs(share) <= GOAL_ERROR:
        return ""
    other = any(len(system.arrays[name]) for name in ("tabled_size", "flex_frame")) or method == "energy_momentum"
    goes_on = "and goes on so" if report.energy_growth else "from its start to its mean, and does not go on so"
    return (
        f"Nothing acts on {system.name!r} but forces with a potential, so its energy should stay, but it "
        f"{'grows' if share > 0.0 else 'falls'} by {_percent(abs(share))} of the largest kinetic energy in "
        f"{report.steps} steps, {goes_on}; {OTHER_STEPS if other else OTHER_METHOD}."
    )


def needed_step(h: float, accuracy: Accuracy) -> float | None:
    """The step that would bring the result to `GOAL_ERROR`, s; None where it is too far off to estimate it."""
    error = accuracy.error
    if error is None or error > RESOLVED or accuracy.order is None:
        return None
    mean_step = h / (1.0 + accuracy.halvings_per_step)
    return float(mean_step * min(GOAL_ERROR / error, 0.5**accuracy.order) ** (1.0 / accuracy.order))


def remedy(system: System, method: str, tried: Sequence[tuple[float, float]]) -> str:
    """The remedy for an inaccurate result, in a sentence.

    `tried`: steps of refined runs, s, the finest last, and their estimated errors, relative to the range.
    """
    sufficient = next(((step, off) for step, off in tried if off <= CLEAR), None)
    if sufficient is None:
        finds = "simulate(..., tolerance=1e-3) in place of a step finds sufficient steps."
        if not tried:
            return f"Which step is sufficient was not tried: {finds}"
        step, off = tried[-1]
        nearer = (
            f"are off by about {_percent(off)} at most" if off <= RESOLVED else "do not show the limit of shorter steps"
        )
        return f"Steps of {step:g} s were tried too, and {nearer}: {finds}"
    better = _higher_orders(system, method)
    names = " or ".join(map(repr, better))
    advice = f"; longer steps may be sufficient with a method of higher order ({names})" if better else ""
    return f"Steps of {sufficient[0]:g} s were tried: they are off by about {_percent(sufficient[1])} at most{advice}."


def error_text(accuracy: Accuracy, sizes: Mapping[str, float], compared: Mapping[str, Compared]) -> str:
    """The estimated error in a sentence, with the worst sensor."""
    name = max(accuracy.sensors, key=lambda n: accuracy.sensors[n] / sizes[n])
    unit, share = compared[name].unit, accuracy.sensors[name] / sizes[name]
    least = "at least" if share > RESOLVED else "about"
    what, of = "coordinate" if unit == COORDINATES else "sensor", unit_text(unit)
    gap, size = f"{accuracy.sensors[name]:.3g}{of}", f"{sizes[name]:.3g}{of}"
    return (
        f"The result is off by {least} {_percent(share)} of the largest range, as a refined run with steps of "
        f"{accuracy.compared_step:g} s shows: {what} '{name}' by {gap} of {size}."
    )


def open_text(accuracy: Accuracy, step: float, most: float, needed: float) -> str:
    """That refined runs have cost the `most` that they may, with a remedy.

    `accuracy`: by the last one; `step`: of the next one, s; `needed`: what all that may follow would cost.
    """
    reason = "there is no estimate"
    if accuracy.error is not None:
        reason = (
            f"the last estimate, with steps of {accuracy.compared_step:g} s, is {_percent(accuracy.error)} of the "
            "largest range"
        )
    return (
        f"Whether the result is off was not checked: a refined run with steps of {step:g} s would cost more than the "
        f"budget of {most:g} runs ({reason}). Allow simulate(..., estimate_error={math.ceil(needed)}), or give it "
        "tolerance=1e-3 in place of a step."
    )


def _higher_orders(system: System, method: str) -> list[str]:
    """Methods of higher order that take the System, for a method of order two."""
    arrays = system.arrays
    if (
        METHOD_TABLE[method].order > 2
        or len(arrays["y0"])
        or (np.asarray(arrays["guide_type"]) != GuideType.OF_TIME).any()
    ):
        return []
    explicit = "semi_recursive" if is_open_tree(system) else "runge_kutta_8"
    return [explicit] + (["radau_5"] if len(arrays["velocity_row"]) == 0 else [])


def _percent(share: float) -> str:
    return f"{100.0 * share:.2g} %" if not 0.995 <= share < 100.0 else f"{100.0 * share:.0f} %"


def _of(unit: str) -> str:
    return f" of the range in {unit}" if unit != COORDINATES else " of the range of coordinates"
