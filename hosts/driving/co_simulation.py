"""The co-simulation loop of one FMU: set inputs, make a communication step, read outputs."""

import math
import time as clock
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np

from ali3.processes import alive
from hosts.common.errors import FailedFmuError
from hosts.common.numbers import Value
from hosts.driving.manoeuvre import Manoeuvre, with_names_of
from hosts.driving.missed_inputs import missed_end, missed_inputs
from hosts.driving.observation import Observation
from hosts.driving.pilots.pilot import Pilot, refuse_missing
from hosts.driving.recorded_rows import RecordedRows
from hosts.driving.result import Result
from hosts.driving.run_checks import check_columns
from hosts.driving.simulated_fmu import SimulatedFmu
from hosts.driving.steady_throttle import with_change_of_speed, with_throttle
from hosts.fmu.fmu import StepRefusedError

_PROGRESS_PERIOD = 0.1  # s


def _setter(fmu: SimulatedFmu, names: Sequence[str]) -> Callable[[Sequence[float]], None]:
    """A function that sets inputs, and only those parameters that have changed, because setting one may be costly."""
    tunable = set(fmu.tunable)
    inputs = [k for k, n in enumerate(names) if n not in tunable]
    set_inputs = fmu.setter([names[k] for k in inputs])
    parameters = {k: fmu.setter([names[k]]) for k in range(len(names)) if k not in inputs}
    last: dict[int, float] = {}

    def set_values(values: Sequence[float]) -> None:
        set_inputs([values[k] for k in inputs] if parameters else values)
        for k, set_parameter in parameters.items():
            if last.get(k) != values[k]:
                set_parameter([values[k]])
                last[k] = values[k]

    return set_values


def _slope_setter(fmu: SimulatedFmu, names: Sequence[str]) -> Callable[[Sequence[float]], None]:
    """A function that sets slopes of inputs for the next step, unless all are zero, as they are after each step."""
    set_slopes = fmu.slope_setter(names)

    def set_nonzero_slopes(slopes: Sequence[float]) -> None:
        if any(slopes):
            set_slopes(slopes)

    return set_nonzero_slopes


def _not_finite_text(time: float, acts: Mapping[str, float], observation: Mapping[str, float]) -> str:
    act = next(f"{n} = {x}" for n, x in acts.items() if not math.isfinite(x))
    fault = next((f": the output {n} of the FMU is {x}" for n, x in observation.items() if not math.isfinite(x)), "")
    return f"At {time:.4g} s the driver asks for {act}{fault}."


def columns_of(fmu: SimulatedFmu, manoeuvre: Manoeuvre) -> tuple[list[str], list[str]]:
    """Inputs, with the parameters that the manoeuvre changes, and outputs: the columns of a run."""
    return fmu.names("input") + [n for n in fmu.tunable if n in manoeuvre.inputs], fmu.names("output")


def run(
    fmu: SimulatedFmu,
    manoeuvre: Manoeuvre,
    step: float,
    driver: Pilot | None = None,
    progress: Callable[[int], None] = lambda done: None,
    until: Callable[[float, Mapping[str, float]], bool] | None = None,
    every: int = 1,
    last: bool = False,
    file: Path | None = None,
) -> Result:
    """Drive an FMU through a manoeuvre.

    If the manoeuvre requires a steady throttle, it is found first in the same instance, which is then reset.

    Real inputs of its table are linear between its rows where the FMU follows input derivatives. Parameters, whole
    numbers, inputs that a driver acts on and all inputs of other FMUs are held over each step.

    Parameters
    ----------
    fmu : SimulatedFmu
        Not yet initialised.
    manoeuvre : Manoeuvre
        With its table, start values and stop time.
    step : float
        Communication step, s.
    driver : Pilot, optional
        Replaces the inputs of its first act in the table.
    progress : callable
        Called with the number of finished steps, at most ten times a second.
    until : callable, optional
        Function of the time and the outputs; the run ends with the first step after which it is true.
    every : int
        Steps from one recorded row to the next; after other steps only outputs that the driver uses are read.
    last : bool
        Whether the last step always has a row, unless the FMU has refused it.
    file : Path, optional
        File of the rows, see `RecordedRows`.

    Returns
    -------
    Result
        Up to the first refused step. Rates among its derived columns are central differences, unless `file` is given.
    """
    manoeuvre = with_names_of(manoeuvre, fmu.variables)
    check_columns(fmu, manoeuvre)
    if manoeuvre.find_throttle:
        manoeuvre = with_throttle(run, fmu, manoeuvre, step)
        return with_change_of_speed(run(fmu, manoeuvre, step, driver, progress, until, every, last, file))
    loop = _Loop(fmu, manoeuvre, step, driver, every, file)
    missed_end_note = missed_end(manoeuvre.stop_time, loop.steps, step) if until is None else None
    begin = next_progress = clock.perf_counter()
    for k in range(loop.steps):
        if not loop.advance(k):
            break
        if (now := clock.perf_counter()) >= next_progress:
            next_progress = now + _PROGRESS_PERIOD
            progress(loop.rows.done)
            alive()
        if until is not None and until(loop.rows.done * step, loop.observation):
            break
    wall = clock.perf_counter() - begin
    progress(loop.rows.done)
    result = loop.result(wall, last, missed_end_note)
    if file is None:
        derive_columns(result, fmu, every > 1)
    return result


class _Loop:
    """Steps of one run: what is set before each of them, and the rows that are recorded."""

    def __init__(
        self, fmu: SimulatedFmu, manoeuvre: Manoeuvre, step: float, driver: Pilot | None, every: int, file: Path | None
    ) -> None:
        self._fmu, self._manoeuvre, self._step, self._driver = fmu, manoeuvre, step, driver
        self._inputs, self._outputs = columns_of(fmu, manoeuvre)
        self._integers = {
            n for n in manoeuvre.inputs if (v := fmu.variables[n]).variability == "discrete" or v.type == "Integer"
        }
        self.observation = Observation(fmu, self._outputs)
        start = {**manoeuvre.start, **manoeuvre.initial(self._integers)}
        fmu.initialise(start)
        if manoeuvre.state is not None:
            fmu.restore_bytes(manoeuvre.state)
        self._acts = driver.act(0.0, self.observation) if driver is not None else {}
        refuse_missing([n for n in self._acts if n not in self._inputs], fmu.path.name)
        self._used = list(dict.fromkeys([*manoeuvre.inputs, *self._acts]))
        held = {*self._integers, *self._acts, *manoeuvre.held, *fmu.tunable}
        self._linear = [n for n in manoeuvre.inputs if n not in held] if fmu.follows_slopes else []
        self._set_inputs, self._set_slopes = _setter(fmu, self._used), _slope_setter(fmu, self._linear)
        self.steps = max(1, round(manoeuvre.stop_time / step))
        self.rows = RecordedRows(
            self.observation,
            _start_inputs(fmu, self._inputs, start),
            [self._inputs.index(n) for n in self._used],
            [self._inputs.index(n) for n in self._linear],
            [float(np.abs(manoeuvre.inputs[n]).max()) for n in self._linear],
            every,
            self.steps,
            file,
        )

    def advance(self, k: int) -> bool:
        """Set the inputs of step k and make it. Returns False if the FMU refuses it."""
        t = k * self._step
        input_values = self._manoeuvre.at(t, self._integers)
        if self._driver is not None:
            self._acts = self._acts if k == 0 else self._driver.act(t, self.observation)
            if not all(map(math.isfinite, self._acts.values())):
                raise FailedFmuError(_not_finite_text(t, self._acts, self.observation))
            input_values |= self._acts
        values = [input_values[n] for n in self._used]
        if self._used:
            self._set_inputs(values)
        self.rows.begin(values)
        if self._linear:
            next_values = self._manoeuvre.at(t + self._step, self._integers, before=True)
            changes = [next_values[n] - input_values[n] for n in self._linear]
            self.rows.move([next_values[n] for n in self._linear], changes)
            self._set_slopes([change / self._step for change in changes])
        try:
            self._fmu.step(self._manoeuvre.state_time + t, self._step)
        except StepRefusedError:
            self.rows.refused = True
            return False
        self.observation.stepped()
        self.rows.end()
        return True

    def result(self, wall: float, last: bool, missed_end_note: tuple[str, str] | None) -> Result:
        """The rows with the remarks on what was not followed. `wall`: time of the loop, s; `last`: see `run`."""
        fmu, manoeuvre, linear, acts, rows = self._fmu, self._manoeuvre, self._linear, self._acts, self.rows
        missed_inputs_note = missed_inputs(manoeuvre, self._step, linear, self._integers, acts)
        recorded, table = rows.close(last)
        names = self._inputs + self._outputs
        followed = {*linear, *self._integers, *fmu.tunable}
        missed = (manoeuvre.late_begin(acts), missed_inputs_note, missed_end_note)
        return Result(
            names=names,
            units={n: fmu.variables[n].unit or "1" for n in names},
            time=self._step * np.array(recorded, dtype=np.float64),
            values=table,
            wall=wall,
            simulated=rows.done * self._step,
            failed_steps=int(rows.refused),
            messages=list(fmu.messages),
            held=[n for n in self._inputs if n not in linear],
            late=[n for n in self._used if n not in followed and (n in acts or n not in manoeuvre.held)],
            jumps=rows.jumps,
            lost=[n for k, n in enumerate(self._inputs) if k in rows.lost],
            missed=[change for change in missed if change is not None],
            start=dict(manoeuvre.start),
        )


def _start_inputs(fmu: SimulatedFmu, inputs: Sequence[str], start: Mapping[str, Value]) -> list[float]:
    """Values of inputs after the initialisation with start values."""
    values: list[float] = fmu.start_values(inputs).tolist()
    for k, name in enumerate(inputs):
        value = start.get(name)
        if value is not None and not isinstance(value, str):
            values[k] = value
    return values


def derive_columns(result: Result, fmu: SimulatedFmu, thinned: bool = False) -> None:
    """Recompute the derived columns of a run in place, from the inputs at the end of each step.

    `thinned`: whether rows of steps are left out; then rates of the run are more accurate, and only NaN are replaced.
    """
    if not any(name in result.names for name in fmu.derived):
        return
    end_values, held_columns = result.values.copy(), [result.names.index(name) for name in result.held]
    if not thinned:
        end_values[1:, held_columns] = result.values[:-1, held_columns]
    for k, before in result.jumps.items():
        end_values[k, : len(before)] = before
    for name, column in fmu.derive(result.names, result.time, end_values).items():
        if name in result.names:
            values = result.values[:, result.names.index(name)]
            values[:] = np.where(np.isnan(values), column, values) if thinned else column
