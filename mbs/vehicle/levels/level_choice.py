"""The cheapest measured level, a fidelity with a step, within tolerances."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from mbs.vehicle.fidelity import Fidelity

OMISSIONS = {
    Fidelity.TABLE: "deformation and stresses, and forces in the links",
    Fidelity.RIGID: "deformation and stresses",
    Fidelity.QUASI_STATIC: "vibration of the frame and the effect of its bending on the motion",
    Fidelity.LOAD_PATHS: "deformations that no recorded load excites, and vibration that is not in their shapes",
    Fidelity.DYNAMIC: "fixed-interface modes above the fifth",
    Fidelity.MANY_MODES: "fixed-interface modes above the fortieth",
}
"""Effects that a fidelity neglects, in words."""


@dataclass(frozen=True)
class LevelChoice:
    """A measured level with its errors and its cost."""

    fidelity: Fidelity
    h: float
    """Step, s."""
    errors: dict[str, float]
    """Largest errors over the manoeuvres, by output."""
    ms_per_second: float
    """Processor time per simulated second in the slowest manoeuvre, ms."""

    @property
    def error(self) -> float:
        """The largest error."""
        return max(self.errors.values())

    @property
    def left_out(self) -> str:
        """Effects that this fidelity neglects."""
        return OMISSIONS[self.fidelity]


def levels(rows: Sequence[Mapping[str, Any]], outputs: Sequence[str]) -> list[LevelChoice]:
    """Levels that were measured in all manoeuvres, with their largest errors and costs.

    `rows`: rows with "manoeuvre", "fidelity" (name), "h_s", "us_per_step", and the error of each output or
    None.
    """
    names = {row["manoeuvre"] for row in rows}
    choices: list[LevelChoice] = []
    for name, h in dict.fromkeys((row["fidelity"], row["h_s"]) for row in rows):
        fidelity = Fidelity.of(name)
        level_rows = [row for row in rows if (row["fidelity"], row["h_s"]) == (name, h)]
        complete = all(row[output] is not None for row in level_rows for output in outputs)
        if fidelity in OMISSIONS and complete and {row["manoeuvre"] for row in level_rows} == names:
            errors = {output: max(row[output] for row in level_rows) for output in outputs}
            choices.append(LevelChoice(fidelity, h, errors, max(1e-3 * row["us_per_step"] / h for row in level_rows)))
    return choices


def cheapest(rows: Sequence[Mapping[str, Any]], tolerances: Mapping[str, float]) -> LevelChoice:
    """The level with the least time per simulated second within tolerances in all measured manoeuvres.

    `rows`: as in `levels`; `tolerances`: largest errors by output. Raises `ValueError` if a tolerance is not positive,
    or no level is within the tolerances.
    """
    for output, tolerance in tolerances.items():
        if not tolerance > 0.0:
            raise ValueError(f"The tolerance on {output} is {tolerance:g}; it must be positive.")
    choices = levels(rows, list(tolerances))
    suitable = [c for c in choices if all(c.errors[output] <= most for output, most in tolerances.items())]
    if suitable:
        return min(suitable, key=lambda c: c.ms_per_second)
    limits = " and ".join(f"{output} right to {most:g}" for output, most in tolerances.items())
    if not choices:
        raise ValueError(
            f"No fidelity that was measured has {limits}: none has all of these outputs in all manoeuvres."
        )
    errors = nearest(choices, tolerances).errors
    error_texts = [f"{output} {error:.2g}" if len(errors) > 1 else f"{error:.2g}" for output, error in errors.items()]
    raise ValueError(f"No fidelity that was measured has {limits}; the best is {' and '.join(error_texts)} away.")


def nearest(choices: Sequence[LevelChoice], tolerances: Mapping[str, float]) -> LevelChoice:
    """The level with the least largest ratio of error and tolerance."""
    return min(choices, key=lambda c: max(c.errors[output] / most for output, most in tolerances.items()))
