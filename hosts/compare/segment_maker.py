"""Makes the segments of a comparison from a log: inputs and start values of the FMU in each."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hosts.common.numbers import Value
from hosts.compare.log_selection import cut
from hosts.compare.replay import replay_manoeuvre
from hosts.compare.segments import GAP, Segment
from hosts.compare.start_values import reference_point, start_values_of_log, start_values_of_origin
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.missed_inputs import missed_inputs
from hosts.driving.run_checks import check_columns
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.input_ranges import beyond_range
from hosts.fmu.named_fmu import NamedFmu
from hosts.fmu.variables import Variable
from hosts.measures.signal import Signal


@dataclass(frozen=True)
class SegmentMaker:
    """What the segments of a comparison are made from; times of signals are s after --from."""

    name: str
    """Name of the manoeuvres."""
    source: FmuSource
    fmu: NamedFmu
    inputs: Mapping[str, Signal]
    outputs: Mapping[str, Signal]
    """All outputs of the log, also those that are not compared: they give the start values."""
    speed: Signal | None
    """Measured speed, if a driver holds it."""
    held: frozenset[str]
    """Inputs that keep the value of a sample up to the next."""
    run_start: Mapping[str, Value] | None
    """Start values of the run that is the log; None if the comparison does not begin with it."""
    begin: float
    """Time of --from in the log, s."""
    set_values: dict[str, Value]
    """Start values that the user set."""
    frequencies: Mapping[str, float]
    """Frequency of the follower, Hz, by input, of inputs whose follower moves as measured."""
    step: float
    """Communication step, s."""
    slopes: bool
    """Whether inputs change during a step."""

    def segments(self, windows: Sequence[tuple[float, float]]) -> tuple[list[Segment], list[str]]:
        """Segments of windows (start and length, s), and notes on the start values and on missed inputs of the first
        window that has any.
        """
        point = reference_point(self.source, self.set_values)
        segments: list[Segment] = []
        start_notes: list[str] = []
        missed_notes: list[str] = []
        for begin, length in windows:
            run_start = None if begin else self.run_start
            outputs = cut(self.outputs, begin, begin + length)
            start, notes = start_values_of_log(self.fmu, outputs, self.set_values, run_start)
            start_notes = start_notes if segments else notes
            given = start if run_start is None else ()
            start_values = start_values_of_origin(start | self.set_values, given, point)
            manoeuvre = self._manoeuvre(begin, length, start_values)
            missed_notes += self._missed_input_notes(manoeuvre, self.begin + begin)
            speed = None if self.speed is None else cut({"": self.speed}, begin, begin + length)[""]
            segments.append(Segment(manoeuvre, speed, 0.0, begin, len(segments) * (length + GAP)))
        return segments, [*start_notes, *missed_notes[:1]]

    @property
    def _integers(self) -> set[str]:
        return {n for n in self.inputs if self.fmu.variables[n].type == "Integer"}

    def _manoeuvre(self, begin: float, length: float, start: Mapping[str, Value]) -> Manoeuvre:
        """The checked manoeuvre of a window; followed inputs within their ranges."""
        manoeuvre = replay_manoeuvre(
            self.name,
            cut(self.inputs, begin, begin + length),
            start,
            length,
            self.step,
            not self.slopes,
            self._integers,
            self.frequencies,
            self.held & self.inputs.keys(),
        )
        for name in self.frequencies:
            variable = self.fmu.table[name]
            np.clip(manoeuvre.inputs[name], variable.low, variable.high, out=manoeuvre.inputs[name])
        check_columns(self.fmu, manoeuvre)
        return manoeuvre

    def _missed_input_notes(self, manoeuvre: Manoeuvre, begin: float) -> list[str]:
        """A sentence if an input has a corner or a jump inside a communication step; otherwise empty."""
        missed = missed_inputs(manoeuvre, self.step, manoeuvre.inputs if self.slopes else (), self._integers)
        origin = f" after {begin:g} s of the log" if begin else ""
        return [] if missed is None else [f"{missed[0]}{origin}: {missed[1]}."]


def is_invertible(values: NDArray[np.float64], variable: Variable) -> bool:
    """Whether the values of an input are within its range with the opposite sign, too, and are not all 0."""
    return bool((values != 0.0).any()) and not beyond_range(variable, -values)
