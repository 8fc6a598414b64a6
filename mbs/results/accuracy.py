"""Error of a run with fixed steps: estimated from the energy balance, and for suspect runs from a refined run."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ali3.message_text import unit_text
from mbs.kernel.header.enumerations import DrivingFunctionType
from mbs.kernel.header.limits import AGREED, MOST_PARTS, RESOLVED, STILL, WRONG_ERROR
from mbs.kernel.header.steps import Balance
from mbs.results.comparison import COORDINATES, INSTANTS, Compared
from mbs.results.run_report import Report
from mbs.results.smooth_laws import is_open_tree
from mbs.settings.methods import METHOD_TABLE
from mbs.system.system import System

OTHER_STEPS, OTHER_METHOD = "shorter steps keep it better", "method='energy_momentum' keeps it better"
MAX_COST = float(MOST_PARTS * MOST_PARTS)  # largest cost of refined runs, in runs, unless `estimate_error` is a number
GOAL_ERROR = AGREED * WRONG_ERROR  # target of a suggested step, and largest error of the energy
CLEAR = 0.03  # of the range: largest error, by order one, of a run that is right
RIGHT = "A refined run, in which they do not, shows that what is compared is right nevertheless."
COARSER, FINER = "coarser", "finer"


class AccuracyWarning(UserWarning):
    """The energy balance of a run or a refined run shows that its result is inaccurate."""


@dataclass(frozen=True)
class Accuracy:
    """Estimated error of a run."""

    energy_balance: float | None
    """Ratio of the work of constraint forces and projections to the energy of the motion; it should be zero. None if
    the method does not measure it (see `Report.energy_error`)."""
    energy_error: float | None
    """That work, J."""
    halvings_per_step: float
    """Mean number of halvings per step."""
    compared_step: float | None = None
    """Step of the last further run, s; None if there was none. It is larger than the step of the run for a coarser run.
    """
    check_cost: float = 0.0
    """Cost of the check: ratio of the steps of all further runs to the steps of the run."""
    order: float | None = None
    """Order of the method, by which the difference from the last further run is scaled."""
    units: dict[str, float] = field(default_factory=dict)
    """Ratio of the largest estimated error to the largest range, by compared unit ("1": coordinates of the System)."""
    sensors: dict[str, float] = field(default_factory=dict)
    """Largest estimated errors of the compared sensors, in their units, by name."""
    others: dict[str, float] = field(default_factory=dict)
    """The same of sensors that are not compared, which decide nothing: one that jumps a little later is off by its
    jump."""
    message: str = ""
    """Evidence against the result, with a remedy; empty if there is none."""
    notice: str = ""
    """A sentence about an open energy balance of a run that its refined run confirms, or about a motion that counts as
    rest and was not compared; otherwise empty."""
    branch: str = ""
    """A sentence about a change of the assembly mode that the refined run does not make; otherwise empty."""

    @property
    def error(self) -> float | None:
        """Largest of `units`; None if no further run estimated it."""
        return max(self.units.values(), default=0.0) if self.compared_step is not None and self.units else None

    def __str__(self) -> str:
        sentences = []
        if self.energy_balance is not None:
            sentences.append(f"energy balance open by {_percent(self.energy_balance)}")
        if self.halvings_per_step > 0.0:
            sentences.append(f"{self.halvings_per_step:.2g} halvings a step")
        if self.units:
            errors = (f"{_percent(e)}{_range_text(unit)}" for unit, e in self.units.items())
            sentences.append(f"estimated error {', '.join(errors)}")
        if self.check_cost > 0.0:
            sentences.append(
                f"checked by runs of {self.check_cost:.2g} times its steps (at most {MAX_COST:g} unless "
                "estimate_error=N; none with estimate_error=False)"
            )
        return "; ".join(sentences)


def required_check(report: Report, method: str, recovered: bool) -> str:
    """Check that a run needs: empty for none, `COARSER` for coarser runs, `FINER` for refined runs.

    `recovered`: whether section forces or stresses are compared. They may vibrate while the motion is smooth.

    An open energy balance and a change of the assembly mode show that steps are too long. So does the energy error of a
    method of high order that makes positions wrong: past a singular position longer steps may have the same by chance.
    """
    has_energy_drift = METHOD_TABLE[method].order > 2 and energy_drift(report) > WRONG_ERROR
    if report.balance != Balance.KEPT or report.branch_changes > 0 or has_energy_drift:
        return FINER
    # divided steps may hide the effect of an abrupt force
    is_undivided = report.halvings == report.divisions == report.abrupt_steps == 0
    return "" if largest_error(report) <= WRONG_ERROR and is_undivided and not recovered else COARSER


def largest_error(report: Report) -> float:
    """Largest error, of the range, to which the missed changes of velocity can grow.

    They are first-order errors; their square, of order two, grows in a chaotic motion by up to e in each radian.
    """
    missed = missed_over_peak(report)
    return max(missed, missed * missed * math.exp(min(rotation(report), 700.0)))


def missed_over_peak(report: Report) -> float:
    """Changes of velocity that ``v + h a`` misses, relative to the largest velocity."""
    # steps cannot miss a constant velocity
    speed = min(report.speed_peak, report.velocity_path) or math.inf
    return report.predictor_path / speed


def energy_drift(report: Report) -> float:
    """Energy balance times (1 + rotation of the motion, rad), because position errors of a wrong energy accumulate."""
    balance = report.energy_balance if abs(report.energy_error) > report.energy_floor else 0.0
    return balance * (1.0 + rotation(report))


def rotation(report: Report) -> float:
    """Rotation of the motion, rad: all changes of the velocity over the largest one."""
    return report.velocity_path / report.speed_peak if report.speed_peak > 0.0 else 0.0


def missed_fraction(report: Report, method: str) -> float:
    """Changes of velocity that ``v + h a`` misses, over all changes: ``h w/2`` of a vibration or impact of w, rad/s.

    Methods of order above two take sums of squares, in which a short event among many smooth steps keeps its weight.
    """
    missed, total = report.predictor_path, report.velocity_path
    if METHOD_TABLE[method].order > 2:
        missed, total = math.sqrt(report.predictor_squares), math.sqrt(report.velocity_squares)
    return missed / total if total > 0.0 else 0.0


def mean_parts(steps: float, halvings: float) -> float:
    """Mean number of parts into which steps were halved."""
    return 1.0 + halvings / max(steps, 1)


def step_divisor(steps: int, halvings: int) -> int:
    """Divisor of the step for a refined run with half of the mean step that was made."""
    return max(2, math.ceil(2.0 * mean_parts(steps, halvings) - 1e-9))


def sampling_interval(every: int, steps: int) -> int:
    """Divisor of `every` with which a run of `steps` steps has enough samples for a comparison."""
    longest = max(1, steps // INSTANTS)
    return next(k for k in range(min(every, longest), 0, -1) if every % k == 0) if isinstance(every, int) else every


def accuracy_from_energy(report: Report, steps: int, halvings: int) -> Accuracy:
    """Accuracy of a run from its energy balance alone, without a refined run."""
    moves = report.kinetic_peak > 0.0
    return Accuracy(
        report.energy_balance if moves else None,
        report.energy_error if moves else None,
        halvings / max(steps, 1),
    )


def balance_text(report: Report) -> str:
    """Sentence about the energy balance; empty unless it shows that the run is wrong."""
    if report.balance != Balance.WRONG:
        return ""
    return (
        f"Constraint forces and projections did {report.energy_error:.3g} J of work, {_percent(report.energy_balance)} "
        f"of the {report.energy_size:.3g} J in the motion; they should do none."
    )


def energy_text(report: Report, system: System, method: str) -> str:
    """Sentence about a change of the energy of a free System, with a remedy; empty if the energy is conserved."""
    change = report.energy_change
    if abs(change) <= GOAL_ERROR:
        return ""
    is_excluded = any(len(system.arrays[name]) for name in ("tabled_size", "flex_frame")) or method == "energy_momentum"
    continuation = "and goes on so" if report.energy_growth else "from its start to its mean, and does not go on so"
    return (
        f"Nothing acts on {system.name!r} but forces with a potential, so its energy should stay, but it "
        f"{'grows' if change > 0.0 else 'falls'} by {_percent(abs(change))} of the largest kinetic energy in "
        f"{report.steps} steps, {continuation}; {OTHER_STEPS if is_excluded else OTHER_METHOD}."
    )


def needed_step(h: float, accuracy: Accuracy) -> float | None:
    """Step with an estimated error of `GOAL_ERROR`, s; None if the error is too large for an estimate."""
    error = accuracy.error
    if error is None or error > RESOLVED or accuracy.order is None:
        return None
    mean_step = h / (1.0 + accuracy.halvings_per_step)
    return float(mean_step * min(GOAL_ERROR / error, 0.5**accuracy.order) ** (1.0 / accuracy.order))


def remedy(system: System, method: str, tried: Sequence[tuple[float, float]]) -> str:
    """Sentence with a remedy for an inaccurate result.

    `tried`: steps of refined runs, s, the finest last, and their estimated errors relative to the range.
    """
    sufficient = next(((step, error) for step, error in tried if error <= CLEAR), None)
    if sufficient is None:
        tolerance_advice = "simulate(..., tolerance=1e-3) instead of a step finds sufficient steps."
        if not tried:
            return f"Which step is sufficient was not tried: {tolerance_advice}"
        step, error = tried[-1]
        outcome = (
            f"are off by about {_percent(error)} at most"
            if error <= RESOLVED
            else "do not show the limit of shorter steps"
        )
        return f"Steps of {step:g} s were tried too, and {outcome}: {tolerance_advice}"
    better = _higher_orders(system, method)
    names = " or ".join(map(repr, better))
    advice = f"; longer steps may be sufficient with a method of higher order ({names})" if better else ""
    return f"Steps of {sufficient[0]:g} s were tried: they are off by about {_percent(sufficient[1])} at most{advice}."


def error_text(accuracy: Accuracy, sizes: Mapping[str, float], compared: Mapping[str, Compared]) -> str:
    """Sentence about the estimated error, with the worst sensor.

    `sizes`: ranges of the compared quantities, in their units, by name.
    """
    name = max(accuracy.sensors, key=lambda n: accuracy.sensors[n] / sizes[n])
    unit, error = compared[name].own_unit or compared[name].unit, accuracy.sensors[name] / sizes[name]
    qualifier = "at least" if error > RESOLVED else "about"
    kind, unit_suffix = "coordinate" if unit == COORDINATES else "sensor", unit_text(unit)
    difference_text, size_text = f"{accuracy.sensors[name]:.3g}{unit_suffix}", f"{sizes[name]:.3g}{unit_suffix}"
    return (
        f"The result is off by {qualifier} {_percent(error)} of the largest range, as a refined run with steps of "
        f"{accuracy.compared_step:g} s shows: {kind} '{name}' by {difference_text} of {size_text}."
    )


def budget_text(accuracy: Accuracy, step: float, max_cost: float, needed: float) -> str:
    """Sentence about a check that ended at the budget of `max_cost` runs, with a remedy.

    `accuracy`: accuracy by the last refined run; `step`: step of the next run, s; `needed`: cost of all that may
    follow, in runs.
    """
    reason = "there is no estimate"
    if accuracy.error is not None:
        reason = (
            f"the last estimate, with steps of {accuracy.compared_step:g} s, is {_percent(accuracy.error)} of the "
            "largest range"
        )
    return (
        f"Whether the result is off was not checked: a refined run with steps of {step:g} s would cost more than the "
        f"budget of {max_cost:g} runs ({reason}). Allow simulate(..., estimate_error={math.ceil(needed)}), or give it "
        "tolerance=1e-3 instead of a step."
    )


def rest_text(values: Mapping[str, NDArray[np.float64]], compared: Mapping[str, Compared]) -> str:
    """Sentence about the sensor that moves farthest where all count as rest, with remedies; empty if it is at rest.

    `values`: samples, shape (n,), by name; `compared`: as `compared_sensors` of the System.
    """
    ranges = {n: quantity.factor * float(np.ptp(values[n])) for n, quantity in compared.items() if quantity.place}
    name = max(ranges, key=ranges.__getitem__, default=None)
    if name is None:
        return ""
    suffix = unit_text(compared[name].own_unit or compared[name].unit)
    moved, largest = float(np.ptp(values[name])), float(np.max(np.abs(values[name])))
    if moved <= STILL * STILL * largest:  # so far a solution settles
        return ""
    return (
        f"Whether the result is off was not checked: sensor '{name}' moves farthest, by {moved:.2g}{suffix} at values "
        f"up to {largest:.3g}{suffix}, and less than {STILL:.0e} of the largest value counts as rest. To check it, "
        "sense the displacement from where it rests, or state the length of the motion, Model(..., length=...)."
    )


def _higher_orders(system: System, method: str) -> list[str]:
    """Methods of higher order that accept the System; empty if `method` has an order above two."""
    arrays = system.arrays
    if (
        METHOD_TABLE[method].order > 2
        or len(arrays["y0"])
        or (np.asarray(arrays["guide_type"]) != DrivingFunctionType.OF_TIME).any()
    ):
        return []
    explicit = "semi_recursive" if is_open_tree(system) else "runge_kutta_8"
    return [explicit] + (["radau_5"] if len(arrays["velocity_row"]) == 0 else [])


def _percent(ratio: float) -> str:
    return f"{100.0 * ratio:.2g} %" if not 0.995 <= ratio < 100.0 else f"{100.0 * ratio:.0f} %"


def _range_text(unit: str) -> str:
    return f" of the range in {unit}" if unit != COORDINATES else " of the range of coordinates"
