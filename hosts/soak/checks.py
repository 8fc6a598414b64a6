"""Checks of a soak test after every step of a drive."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from hosts.common.wheels import WHEELS

LARGEST_BALANCE = 0.05
"""Of `solver.energy_balance`: above it an FMU without prescribed motion warns itself."""

_SETTLED = 100  # steps of a run before its energy is checked
_WORKS = tuple(f"energy.{name}" for name in ("drive", "brakes", "tyres", "dampers", "drag", "ground"))
_OVERTURNED_HEIGHT = 0.3  # of the height of a unit vector that points up in the car
# m, of a car on its road
_LOWEST = -5.0
_HIGHEST = 100.0


class BadStepError(Exception):
    """A step with a fault; `kind` is a word for the table."""

    def __init__(self, kind: str, text: str) -> None:
        super().__init__(text)
        self.kind = kind


@dataclass
class Counts:
    """Numbers of a drive; see `docs/driving.md`."""

    steps: int = 0
    top_speed: float = 0.0
    farthest: float = 0.0
    jumps: int = 0
    longest_jump: float = 0.0
    highest: float = 0.0
    rollovers: int = 0
    largest_balance: float = 0.0
    largest_open_energy: float = 0.0
    most_iterations: float = 0.0
    halvings: float = 0.0
    capped: float = 0.0


class Watch:
    """Counts and checks the outputs after each step.

    `outputs`: names; missing ones are not checked; `step`: s; `largest_balance`: of `solver.energy_balance`.
    """

    def __init__(self, outputs: Sequence[str], step: float, largest_balance: float = LARGEST_BALANCE) -> None:
        self.counts = Counts()
        self._indices = {name: k for k, name in enumerate(outputs)}
        self._outputs, self._step, self._largest = list(outputs), step, largest_balance
        self._loads = self._group(f"wheel_{wheel}.Fz" for wheel in WHEELS)
        self._works = self._group(_WORKS) + self._group(("energy.added",))
        self._total, self._error = self._index("energy.total"), self._index("solver.energy_error")
        self._balance, self._kinetic = self._index("solver.energy_balance"), self._index("energy.kinetic")
        self._speed, self._iterations = self._index("speed"), self._index("solver.iterations")
        self._halvings, self._capped = self._index("solver.halvings"), self._index("solver.capped_steps")
        self._position = self._group(f"chassis.{axis}" for axis in "xyz")
        self._tilt = self._group(("chassis.qx", "chassis.qy"))
        self._ground = self._index("chassis.ground_points")
        self.overturned = False
        self.begin([0.0] * len(outputs))

    def begin(self, row: Sequence[float]) -> None:
        """Begin with a new start of the car, with these outputs."""
        self._steps, self._airborne_steps, self.overturned = 0, 0, False
        self._begin_total = row[self._total] if self._total >= 0 else 0.0
        self._largest_kinetic = 0.0
        self._last_counts = 0.0, 0.0

    def step(self, row: Sequence[float]) -> None:
        """Count and check a step. Raises `BadStepError`."""
        counts = self.counts
        counts.steps += 1
        self._steps += 1
        if not math.isfinite(sum(row)):
            name = next(
                (n for n, x in zip(self._outputs, row, strict=True) if not math.isfinite(x)), "a sum of outputs"
            )
            raise BadStepError("not finite", f"{name} is not a finite number.")
        self._check_motion(row)
        if self._iterations >= 0:
            counts.most_iterations = max(counts.most_iterations, row[self._iterations])
        halvings = row[self._halvings] if self._halvings >= 0 else 0.0
        capped = row[self._capped] if self._capped >= 0 else 0.0
        counts.halvings += halvings - self._last_counts[0]
        counts.capped += capped - self._last_counts[1]
        self._last_counts = halvings, capped
        self._check_energy(row)

    def _check_motion(self, row: Sequence[float]) -> None:
        counts = self.counts
        if self._speed >= 0:
            counts.top_speed = max(counts.top_speed, row[self._speed])
        if self._position:
            x, y, z = (row[k] for k in self._position)
            counts.farthest = max(counts.farthest, math.hypot(x, y))
            counts.highest = max(counts.highest, z)
            if not _LOWEST < z < _HIGHEST:
                raise BadStepError("left the road", f"chassis.z is {z:g} m.")
        if self._loads:
            has_ground_contact = self._ground >= 0 and row[self._ground] > 0.0
            is_airborne = not any(row[k] > 0.0 for k in self._loads) and not has_ground_contact
            self._airborne_steps = self._airborne_steps + 1 if is_airborne else 0
            counts.longest_jump = max(counts.longest_jump, self._airborne_steps * self._step)
            counts.jumps += self._airborne_steps == round(0.1 / self._step)
        if self._tilt:
            up = 1.0 - 2.0 * sum(row[k] ** 2 for k in self._tilt)
            counts.rollovers += up < _OVERTURNED_HEIGHT and not self.overturned
            self.overturned = up < _OVERTURNED_HEIGHT if not self.overturned else up < 2.0 * _OVERTURNED_HEIGHT

    def _check_energy(self, row: Sequence[float]) -> None:
        if self._steps < _SETTLED:
            return
        if self._kinetic >= 0 and self._works and self._total >= 0 and self._error >= 0:
            self._largest_kinetic = max(self._largest_kinetic, row[self._kinetic])
            works = [row[k] for k in self._works]
            open_energy = row[self._total] - self._begin_total - sum(works) - row[self._error]
            size = self._largest_kinetic + sum(map(abs, works))
            self.counts.largest_open_energy = max(self.counts.largest_open_energy, abs(open_energy) / max(size, 1.0))
        if self._balance >= 0:
            balance = row[self._balance]
            self.counts.largest_balance = max(self.counts.largest_balance, balance)
            if balance > self._largest:
                raise BadStepError(
                    "energy", f"solver.energy_balance is {balance:.3g}; at most {self._largest:g} is good."
                )

    def _index(self, name: str) -> int:
        return self._indices.get(name, -1)

    def _group(self, names: Iterable[str]) -> list[int]:
        """Indices of several outputs, none if one is missing."""
        indices = [self._index(name) for name in names]
        return indices if min(indices) >= 0 else []
