"""Pair of runs with two tolerances of one motion, and the error of the finer one estimated from them."""

from dataclasses import dataclass
from functools import cached_property

from mbs.kernel.header.limits import AGREED
from mbs.results.comparison import COORDINATES, Compared, compared_sensors
from mbs.settings.tolerance import Tolerance
from mbs.simulation.controlled_run import ControlledRun
from mbs.simulation.prepared_system import prepared


@dataclass(frozen=True)
class ControlledPair:
    """A run, and a coarser one."""

    run: ControlledRun
    before: ControlledRun
    tolerance: Tolerance

    @cached_property
    def gaps(self) -> dict[str, float]:
        """Largest differences of the sensors that have a tolerance of their own."""
        system = self.run.simulation.system
        compared, names = compared_sensors(system), [s["name"] for s in prepared(system)[1]["sensors"]]
        gaps = dict[str, float]()
        for name in self.tolerance.sensors:
            fine, coarse = (run.values[:, names.index(name)] for run in (self.run, self.before))
            gaps[name] = compared.get(name, Compared(COORDINATES)).gap(fine, coarse)
        return gaps

    @property
    def fall(self) -> float:
        """The error of the run over that of the coarser one: as what their steps have erred."""
        coarse = self.before.fields.error_sum
        return min(1.0, self.run.fields.error_sum / coarse) if coarse > 0.0 else 1.0

    @property
    def apart(self) -> float:
        """Distance of both in parts of the length, or of what sensors may differ by, times the share."""
        if not self.tolerance.sensors:
            return self.run.distance(self.before)
        return self.tolerance.share * max(gap / self.tolerance.sensors[name] for name, gap in self.gaps.items())

    @property
    def errors(self) -> dict[str, float]:
        """The guessed errors of the sensors that have a tolerance of their own."""
        least = {name: AGREED * allowed for name, allowed in self.tolerance.sensors.items()}
        return {name: max(self.fall * gap, least[name]) for name, gap in self.gaps.items()}
