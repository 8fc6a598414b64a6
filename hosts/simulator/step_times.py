"""Costs, lateness and causes of lateness of the steps: histograms of fixed size, their text and their JSON."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hosts.simulator.clock import Clock

_FIRST = 1e-6
_DECADES = 7
_PER_DECADE = 40
CAUSES = ("ran", "others", "stolen")
"""``ran``: the step itself; ``others``: other programs while it was ready; ``stolen``: a stalled processor."""
BINS = _DECADES * _PER_DECADE + 2
"""Bins of a histogram: below 1 us, 40 in each decade up to 10 s, above."""
_SCALARS = (
    *("steps", "simulated", "scheduled", "wall", "paused", "missed", "skipped", "lost"),
    *("cost_sum", "cost_largest", "lateness_largest", "capped", "capped_largest"),
    *CAUSES,
)
_INDICES = {name: k for k, name in enumerate(_SCALARS)}
TIMES_SIZE = len(_SCALARS) + 2 * BINS
"""Doubles of a record."""
_COST = len(_SCALARS)
_LATENESS = len(_SCALARS) + BINS
_QUANTILES = (("median", 0.5), ("p99", 0.99), ("p999", 0.999))


class LateCauses:
    """Determines the cause with the longest time. `clock`: clock of the calling thread.

    The host of a virtual machine may withdraw processors ("steal"), which no priority within the machine prevents.
    Linux reports the run time of a thread, including interrupts and unreported steal, and its wait time while others
    ran.
    """

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self.restart()

    def restart(self) -> None:
        """Start counting again, so that earlier work of the thread belongs to no step."""
        self._before, self._cause = self._clock.spent(), ""

    def of_step(self, elapsed: float, period: float, late: bool) -> str:
        """Take a step into account.

        `elapsed`: time from its scheduled start, or a later end of the step before, to its end, s; `period`: its
        scheduled length, s; `late`: whether it missed its deadline. Returns one of `CAUSES`, or an empty text if the
        step was not late or the cause is not known. A step that is late only because of the one before has the same
        cause.
        """
        spent = self._clock.spent()
        if spent is None or self._before is None:
            return ""
        ran, waited = (now - before for now, before in zip(spent, self._before, strict=True))
        self._before = spent
        if not late:
            self._cause = ""
        elif elapsed > period or not self._cause:
            durations = dict(zip(CAUSES, (ran, waited, elapsed - ran - waited), strict=True))
            self._cause = max(durations, key=lambda name: durations[name])
        return self._cause


def bin_of(seconds: float) -> int:
    """The bin of a time, s."""
    if seconds <= _FIRST:
        return 0
    return min(1 + int(_PER_DECADE * math.log10(seconds / _FIRST)), BINS - 1)


class TimesRecord:
    """The record to which the loop of the car adds steps. `values`: initially zero, shape (TIMES_SIZE,)."""

    def __init__(self, values: NDArray[np.float64]) -> None:
        self._values = memoryview(values.data).cast("B").cast("d")

    def add(self, name: str, amount: float) -> None:
        """Add to a figure: steps, simulated, scheduled, wall, paused, missed, skipped, lost, capped, `CAUSES`."""
        self._values[_INDICES[name]] += amount

    def __getitem__(self, name: str) -> float:
        return self._values[_INDICES[name]]

    def add_step(self, cost: float, lateness: float) -> None:
        """Count a step. `cost`: its wall time, s; `lateness`: delay of its start, s."""
        values = self._values
        values[_COST + bin_of(cost)] += 1.0
        values[_LATENESS + bin_of(lateness)] += 1.0
        self.add("cost_sum", cost)
        self.raise_to("cost_largest", cost)
        self.raise_to("lateness_largest", lateness)

    def raise_to(self, name: str, value: float) -> None:
        """Raise a maximum to a value: cost_largest, lateness_largest, capped_largest."""
        if value > self._values[_INDICES[name]]:
            self._values[_INDICES[name]] = value


@dataclass(frozen=True)
class Spread:
    """A histogram and its largest value."""

    counts: NDArray[np.float64]
    """Shape (BINS,)."""
    largest: float
    """s."""

    def quantile(self, probability: float) -> float:
        """The quantile, s, as the upper edge of its bin (6 %); 0 without steps. `probability`: number from 0 to 1."""
        total = float(self.counts.sum())
        if total == 0.0:
            return 0.0
        index = int(np.searchsorted(np.cumsum(self.counts), probability * total))
        return min(self.largest, edge(index))

    def report(self) -> dict[str, Any]:
        occupied = np.flatnonzero(self.counts)
        bins = [[min(edge(int(k)), self.largest), int(self.counts[k])] for k in occupied]
        return {name: self.quantile(probability) for name, probability in _QUANTILES} | {
            "largest": self.largest,
            "bins": bins,
        }

    def words(self) -> str:
        quantiles = [self.quantile(probability) for _, probability in _QUANTILES]
        pairs = zip(("median", "p99", "p99.9", "largest"), (*quantiles, self.largest), strict=True)
        return ", ".join(f"{name} {1e3 * value:.3g} ms" for name, value in pairs)

    def lines(self) -> list[str]:
        """Lines of a chart with a bar for each third of a decade that has steps."""
        rows: dict[float, float] = {}
        for k in np.flatnonzero(self.counts):
            top = next(t for t in _CHART_EDGES if t >= edge(int(k)) * (1.0 - 1e-9))
            rows[top] = rows.get(top, 0.0) + float(self.counts[k])
        highest = max(rows.values(), default=1.0)
        return [
            f"  <= {1e3 * t:>8g} ms {int(n):>10}  {'#' * math.ceil(40.0 * n / highest)}"
            for t, n in sorted(rows.items())
        ]


def edge(index: int) -> float:
    """Upper edge of a bin, s; infinite for the last."""
    return math.inf if index >= BINS - 1 else float(_FIRST * 10.0 ** (index / _PER_DECADE))


_CHART_EDGES = [float(f"{m}e{e}") for e in range(-6, 2) for m in (1, 2, 5)] + [math.inf]


@dataclass(frozen=True)
class StepTimes:
    """Times of the steps so far."""

    step: float
    """Communication step, s."""
    paced: bool
    steps: int
    simulated: float
    """Simulated time of these steps, s."""
    scheduled: float
    """Wall time of these steps at the requested speeds, s."""
    wall: float
    """Wall time in which the car ran, s."""
    paused: float
    """Wall time in which the car was paused, s."""
    missed: int
    """Number of steps that ended after the scheduled start of the next."""
    missed_by: dict[str, int]
    """Their number by each of `CAUSES`; all zero if the system does not report causes."""
    skipped: int
    """Number of times at which the schedule was moved because the car was too late."""
    lost: float
    """Wall time by which the schedule was moved, s."""
    cost: Spread
    """Wall time of a step, s."""
    lateness: Spread
    """Delay of the start of a step, s."""
    mean: float
    """Mean cost, s."""
    capped: int
    """Inner steps of the FMU that ended at the limit of iterations."""
    capped_residual: float
    """Largest residual of these, m."""

    @staticmethod
    def of(values: NDArray[np.float64], step: float, paced: bool) -> StepTimes:
        """The times of a record of the loop."""
        v = values.copy()
        scalar = {name: float(v[k]) for name, k in _INDICES.items()}
        steps = int(scalar["steps"])
        return StepTimes(
            step,
            paced,
            steps,
            scalar["simulated"],
            scalar["scheduled"],
            scalar["wall"],
            scalar["paused"],
            int(scalar["missed"]),
            {name: int(scalar[name]) for name in CAUSES},
            int(scalar["skipped"]),
            scalar["lost"],
            Spread(v[_COST : _COST + BINS], scalar["cost_largest"]),
            Spread(v[_LATENESS : _LATENESS + BINS], scalar["lateness_largest"]),
            scalar["cost_sum"] / max(1, steps),
            int(scalar["capped"]),
            scalar["capped_largest"],
        )

    @property
    def factor(self) -> float:
        """Scheduled over wall time while the car ran: 1 if it kept up, at any requested speed."""
        return self.scheduled / self.wall if self.wall > 0.0 else 1.0

    def report(self) -> dict[str, Any]:
        """For JSON; times in s, `bins` as upper edge and count."""
        spreads = {"cost": self.cost.report(), "lateness": self.lateness.report()}
        return vars(self) | {"factor": self.factor} | spreads

    def text(self) -> str:
        """The times as text."""
        if not self.steps:
            return f"No step was computed; paused for {self.paused:.1f} s."
        ratio = self.simulated / self.wall if self.wall > 0.0 else math.inf
        rows = [
            f"{self.steps} steps of {1e3 * self.step:g} ms: {self.simulated:.3f} s simulated in {self.wall:.3f} s of "
            f"wall time (ratio {ratio:.4f}), besides {self.paused:.1f} s paused",
            f"cost of a step: {self.cost.words()}, mean {1e3 * self.mean:.3g} ms",
        ]
        if self.paced:
            if abs(self.scheduled - self.simulated) > 1e-6 * self.simulated:
                rows.append(f"at the speeds that were asked for (slow motion) this takes {self.scheduled:.3f} s")
            # deadlines left out by a moved schedule are missed too
            deadlines = max(self.missed, round(self.steps * (1.0 + self.lost / self.scheduled)))
            rows += [
                f"lateness of its start: {self.lateness.words()}",
                f"missed deadlines: {self.missed} of {deadlines} ({100.0 * self.missed / deadlines:.3g} %)",
            ]
            if any(self.missed_by.values()):
                ran, waited, stolen = (self.missed_by[name] for name in CAUSES)
                rows.append(
                    f"  while the step ran (work, interrupts, what a host took without a word): {ran}; other programs: "
                    f"{waited}; the processor stood still, as where the host of a virtual machine takes it: {stolen}"
                )
            if self.skipped:
                rows.append(
                    f"too slow: the schedule was moved on {self.skipped} times, by {self.lost:.3f} s in all; "
                    f"{self.factor:.3f} of the speed that was asked for was reached"
                )
        if self.capped:
            residual = f"the largest residual left was {1e3 * self.capped_residual:.3g} mm"
            rows.append(f"inner steps stopped, or left whole, at the limit of iterations: {self.capped}; {residual}")
        return "\n".join([*rows, "histogram of the costs:", *self.cost.lines()])
