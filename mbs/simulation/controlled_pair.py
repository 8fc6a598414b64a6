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
    """A run and a coarser one; `tolerance`: the requested one."""

    run: ControlledRun
    coarser: ControlledRun
    tolerance: Tolerance

    @cached_property
    def differences(self) -> dict[str, float]:
        """Largest differences of the sensors with their own tolerance, in their units."""
        system = self.run.simulation.system
        compared, names = compared_sensors(system), [s["name"] for s in prepared(system).meta["sensors"]]
        differences = dict[str, float]()
        for name in self.tolerance.sensors:
            fine, coarse = (run.values[:, names.index(name)] for run in (self.run, self.coarser))
            differences[name] = compared.get(name, Compared(COORDINATES)).gap(fine, coarse)
        return differences

    @property
    def error_ratio(self) -> float:
        """Ratio of the error of the run to that of the coarser one, from the sums of their step errors, at most 1."""
        coarse = self.coarser.fields.error_sum
        return min(1.0, self.run.fields.error_sum / coarse) if coarse > 0.0 else 1.0

    @property
    def distance(self) -> float:
        """Distance of both runs relative to the length.

        With sensors: their largest ratio of difference to tolerance, times the tolerance of positions.
        """
        if not self.tolerance.sensors:
            return self.run.distance(self.coarser)
        return self.tolerance.position * max(
            gap / self.tolerance.sensors[name] for name, gap in self.differences.items()
        )

    @property
    def errors(self) -> dict[str, float]:
        """Estimated errors of the sensors with their own tolerance, in their units."""
        least = {name: AGREED * allowed for name, allowed in self.tolerance.sensors.items()}
        return {name: max(self.error_ratio * gap, least[name]) for name, gap in self.differences.items()}
