"""The co-simulation loop: inputs in, a communication step, outputs out."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hosts.common.errors import HostError
from hosts.driving.manoeuvre import Manoeuvre, with_names_of
from hosts.driving.pilots.pilot import Pilot
from hosts.driving.run_checks import check_columns
from hosts.driving.senses import Senses
from hosts.driving.simulated_fmu import SimulatedFmu
from hosts.fmu.fmu import StepRefusedError

# Of a value that is reached at the end of a step and set again for the next.
_ROUND_OFF = 1e-9


@dataclass(frozen=True)
class Result:
    """What a run recorded.

    Parameters
    ----------
    names : list of str
        Inputs and outputs.
    units : dict of str to str
        By name.
    time : ndarray of shape (n,)
        s.
    values : ndarray of shape (n, len(names))
        In the units of the model description. Inputs are those with which the next step begins; in the last row those
        with which the last step ended, or with which one that was refused would have begun.
    wall : float
        Time spent in the loop, s.
    simulated : float
        s.
    failed_steps : int
        Communication steps the FMU refused; the run ends with the first.
    messages : list of str
        What the FMU logged at warning or above.
    held : list of str
        Inputs that kept their value over each step; the others went straight.
    late : list of str
        Those of them that were to move between the steps: the FMU takes no input derivatives, or a driver acts on them.
    jumps : dict of int to list of float
        By the number of a row: inputs before a jump at its time, where the row alone does not tell them.
    starts : list of int
        Rows at which runs begin that were put one after the other.
    lost : list of str
        Inputs that moved between the rows otherwise than the rows tell, where not every step has one.
    """

    names: list[str]
    units: dict[str, str]
    time: NDArray[np.float64]
    values: NDArray[np.float64]
    wall: float
    simulated: float
    failed_steps: int
    messages: list[str]
    held: list[str] = field(default_factory=list)
    late: list[str] = field(default_factory=list)
    jumps: dict[int, list[float]] = field(default_factory=dict)
    starts: list[int] = field(default_factory=lambda: [0])
    lost: list[str] = field(default_factory=list)

    def __contains__(self, name: str) -> bool:
        return name in self.names

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        return np.asarray(self.values[:, self.names.index(name)])


def run_with_bar(
    fmu: SimulatedFmu, manoeuvre: Manoeuvre, step: float, driver: Pilot | None = None, every: int = 1
) -> Result:
    """`run` with a progress bar on the terminal; its last step has a row also where the stop time has none."""
    from ali3.bars import bar as bar_of

    steps, what = max(1, round(manoeuvre.stop_time / step)), f"{fmu.path.stem}, {manoeuvre.name}"
    with bar_of(total=steps, desc=what, unit="step") as bar:
        return run(fmu, manoeuvre, step, driver, lambda done: bar.update(done - bar.n), every=every, last=True)


def _setter(fmu: SimulatedFmu, names: Sequence[str]) -> Callable[[Sequence[float]], None]:
    """Sets inputs, and those of the parameters that have changed: a parameter may be dear."""
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


def _line_follower(fmu: SimulatedFmu, names: Sequence[str]) -> Callable[[Sequence[float]], None]:
    """Sets slopes of inputs for the next step; nothing where all are zero, which they are after each step."""
    set_slopes = fmu.slope_setter(names)

    def follow(slopes: Sequence[float]) -> None:
        if any(slopes):
            set_slopes(slopes)

    return follow


def _not_finite(time: float, acts: Mapping[str, float], senses: Mapping[str, float]) -> str:
    act = next(f"{n} = {x}" for n, x in acts.items() if not math.isfinite(x))
    sense = next((f": the output {n} of the FMU is {x}" for n, x in senses.items() if not math.isfinite(x)), "")
    return f"At {time:.4g} s who drives asks for {act}{sense}."


def run(
    fmu: SimulatedFmu,
    manoeuvre: Manoeuvre,
    step: float,
    driver: Pilot | None = None,
    progress: Callable[[int], None] = lambda done: None,
    until: Callable[[float, Mapping[str, float]], bool] | None = None,
    every: int = 1,
    last: bool = False,
) -> Result:
    """Drive an FMU through a manoeuvre.

    Real inputs of its table go straight between its rows where the FMU follows input derivatives. Parameters, whole
    numbers, inputs that a driver acts on and all inputs of other FMUs are held over each step.

    Parameters
    ----------
    fmu : SimulatedFmu
        Not yet initialised.
    step : float
        Communication step, s.
    driver : Pilot, optional
        Overrules the inputs it acts on, which are those of its first act.
    progress : callable
        Called with the number of finished steps from time to time.
    until : callable, optional
        Of the time and the outputs; the run ends with the first step after which it is true.
    every : int
        Steps from one recorded row to the next. Outputs that are `hosts.driving.senses.DEAR` are read in the others
        where who drives looks at one.
    last : bool
        Whether the last step has a row in any case, which then comes sooner than the others.

    Returns
    -------
    Result
        Up to the first refused step.
    """
    outputs = fmu.names("output")
    manoeuvre = with_names_of(manoeuvre, fmu.variables)
    check_columns(fmu, manoeuvre)
    inputs = fmu.names("input") + [n for n in fmu.tunable if n in manoeuvre.inputs]
    discrete = {n for n in manoeuvre.inputs if fmu.variables[n].variability == "discrete"}
    whole = discrete | {n for n in manoeuvre.inputs if fmu.variables[n].type == "Integer"}
    senses = Senses(fmu, outputs, every == 1)

    first = manoeuvre.initial(whole)
    fmu.initialise({**manoeuvre.start, **first})
    if manoeuvre.state is not None:
        fmu.restore_bytes(manoeuvre.state)
    senses.read()
    acts = driver.act(0.0, senses) if driver is not None else {}
    missing = [n for n in acts if n not in inputs]
    if missing:
        raise HostError(f"The driver needs variables that {fmu.path.name} does not have: {', '.join(missing)}.")
    used = list(dict.fromkeys([*manoeuvre.inputs, *acts]))
    set_inputs = _setter(fmu, used)
    steps = max(1, round(manoeuvre.stop_time / step))
    values = np.empty((steps // every + 2, len(inputs) + len(outputs)))
    columns = [inputs.index(n) for n in used]
    held = fmu.start_values(inputs)
    for name, value in {**manoeuvre.start, **first}.items():
        if name in inputs and not isinstance(value, str):
            held[inputs.index(name)] = value
    values[0, len(inputs) :] = senses.whole()
    straight = [
        n for n in manoeuvre.inputs if n in fmu.names("input") and n not in {*whole, *acts, *manoeuvre.held}
    ]  # fmt: skip
    straight = straight if fmu.follows_slopes else []
    places, follow = [inputs.index(n) for n in straight], _line_follower(fmu, straight)
    jumps: dict[int, list[float]] = {}
    lost, slopes = np.zeros(len(inputs), bool), list[float]()
    sizes = np.array([np.abs(manoeuvre.inputs[n]).max() for n in straight])
    done, failed = 0, 0
    begin = clock.perf_counter()
    for k in range(steps):
        t = k * step
        wanted = manoeuvre.at(t, whole)
        if driver is not None:
            acts = acts if k == 0 else driver.act(t, senses)
            if not all(map(math.isfinite, acts.values())):
                raise HostError(_not_finite(t, acts, senses))
            wanted |= acts
        now = [wanted[n] for n in used]
        before = held.copy()
        if used:
            set_inputs(now)
            held[columns] = now
        jumped = np.abs(held - before) > _ROUND_OFF * (np.abs(held) + np.abs(before))
        if k % every:
            lost |= jumped
        else:
            values[k // every, : len(inputs)] = held
            if every > 1 or jumped[places if k else columns].any():
                jumps[k // every] = before.tolist()
        if straight:
            then = manoeuvre.at(t + step, whole, before=True)
            earlier, slopes = slopes, [(then[n] - wanted[n]) / step for n in straight]
            if k % every:
                lost[places] |= np.abs(np.subtract(slopes, earlier)) * step > _ROUND_OFF * sizes
            follow(slopes)
            held[places] = [then[n] for n in straight]
        try:
            fmu.step(manoeuvre.state_time + t, step)
        except StepRefusedError:
            failed = 1
            held[places] = [wanted[n] for n in straight]
            break
        done = k + 1
        senses.read()
        if done % every == 0:
            values[done // every] = [*held, *senses.whole()]
        if done % 50 == 0:
            progress(done)
        if until is not None and until(done * step, senses):
            break
    wall = clock.perf_counter() - begin
    progress(done)
    rows = [*range(0, done + 1, every)]
    if last and done % every:
        if failed:
            jumps[len(rows)] = before.tolist()
        values[len(rows)] = [*held, *senses.whole()]
        rows.append(done)
    names = inputs + outputs
    return Result(
        names,
        {n: fmu.variables[n].unit or "1" for n in names},
        step * np.array(rows, dtype=np.float64),
        values[: len(rows)],
        wall,
        done * step,
        failed,
        list(fmu.messages),
        [n for n in inputs if n not in straight],
        [n for n in used if n not in {*straight, *whole, *fmu.tunable} and (n in acts or n not in manoeuvre.held)],
        jumps,
        lost=[n for n, gone in zip(inputs, lost.tolist(), strict=True) if gone],
    )
