"""FMUs that are stepped together: a small master for systems of a car and its partners."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.fmu import Fmu
from hosts.systems.wires import Wire, wires_of

Array = NDArray[np.float64]
Order = Literal["in turn", "at once"]
Inputs = Literal["held", "followed", "repeated"]
ORDERS, INPUTS = ("in turn", "at once"), ("held", "followed", "repeated")


@dataclass
class _Part:
    """A part with what its wires read and set, prepared once."""

    name: str
    fmu: Fmu
    wires: tuple[Wire, ...]
    give: Callable[[Sequence[float]], None]
    set_slopes: Callable[[Sequence[float]], None] | None
    outputs: tuple[str, ...]
    read: Callable[[], list[float]]
    last: Array | None = None
    told: set[str] = field(default_factory=set)


class CoupledFmus:
    """A system of FMUs that exchange values at communication points.

    Parameters
    ----------
    parts : mapping of str to Path
        FMUs by the names that they have here, in the order in which they are initialised and stepped.
    connections : mapping of str to str
        Outputs by the inputs that take them, each as ``part.variable``.
    step : float
        Communication step, s.
    order : {"in turn", "at once"}
        In turn each part gets what those before it have at the end of the step; at once all get what was at its start.
    inputs : {"held", "followed", "repeated"}
        Of parts whose inputs may follow derivatives: held over a step; going on as in the last step, or to where those
        stepped before have come; or each step is made, taken back to saved states, and made again along what it gave.

    Attributes
    ----------
    time : float
        s.
    messages : list of str
        What the parts said at warning or above, and values on wires that are not finite, each with its part.

    Raises
    ------
    HostError
        A part, wire or option is not what it must be.
    """

    def __init__(
        self,
        parts: Mapping[str, Path],
        connections: Mapping[str, str],
        *,
        step: float,
        order: Order = "in turn",
        inputs: Inputs = "held",
    ) -> None:
        if order not in ORDERS or inputs not in INPUTS:
            raise HostError(f"order '{order}', inputs '{inputs}'; they are out of {ORDERS} and {INPUTS}.")
        if not 0.0 < step < np.inf:
            raise HostError(f"The communication step is {step!r} s; it must be a positive number.")
        self.step_length, self.order, self.inputs = float(step), order, inputs
        self._steps, self._own = 0, list[str]()
        with ExitStack() as stack:
            fmus = {name: stack.enter_context(Fmu(Path(path))) for name, path in parts.items()}
            wires = wires_of(connections, fmus)
            self._parts = [_part(name, fmu, wires) for name, fmu in fmus.items()]
            self._stack = stack.pop_all()
        if inputs == "repeated":
            cannot = [p.name for p in self._parts if not p.fmu.description.coSimulation.canGetAndSetFMUstate]
            if cannot:
                self.close()
                raise HostError(f"The part '{cannot[0]}' cannot save its state; its steps cannot be repeated.")

    def __enter__(self) -> CoupledFmus:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Free the instances."""
        self._stack.close()

    @property
    def time(self) -> float:
        """Time of the system, s."""
        return self._steps * self.step_length

    @property
    def messages(self) -> list[str]:
        """What was said, with the part that says it."""
        return [f"{p.name}: {text}" for p in self._parts for text in p.fmu.messages] + self._own

    def fmu(self, name: str) -> Fmu:
        """A part; inputs that no wire sets are set there."""
        return next(p.fmu for p in self._parts if p.name == name)

    def initialise(self, **start: Value) -> None:
        """Start all parts at the time 0, each with what those before it give.

        Parameters
        ----------
        **start : float, int, str
            Parameters and inputs as ``part.variable``.

        Raises
        ------
        HostError
            There is no such part, or a part does not take its values.
        """
        by_part: dict[str, dict[str, Value]] = {p.name: {} for p in self._parts}
        for text, value in start.items():
            part, _, name = text.partition(".")
            if part not in by_part:
                raise HostError(f"'{text}' names no part; the parts are {', '.join(by_part)}.")
            by_part[part][name] = value
        now: dict[tuple[str, str], float] = {}
        for p in self._parts:
            fed = {w.input: now[w.source, w.output] for w in p.wires if (w.source, w.output) in now}
            p.fmu.initialise(fed | by_part[p.name])
            now |= self._outputs(p)
        self._now, self._steps = now, 0

    def step(self) -> None:
        """A communication step of all parts.

        Raises
        ------
        hosts.fmu.fmu.StepRefusedError
            A part refused it.
        """
        begin = self._now
        if self.inputs == "repeated":
            with self._saved() as restore:
                last = self._pass(begin, None)
                restore()
                last = self._pass(begin, last)
        else:
            last = self._pass(begin, None)
        self._now = last
        self._steps += 1

    def read(self, names: Sequence[str]) -> Array:
        """Values of variables now, each named as ``part.variable``; shape (len(names),)."""
        return np.array([self.fmu(part).getter([name])()[0] for part, _, name in (n.partition(".") for n in names)])

    def run(self, duration: float, names: Sequence[str], act: Callable[[CoupledFmus], None] | None = None) -> Array:
        """Steps over a time.

        Parameters
        ----------
        duration : float
            s.
        names : sequence of str
            What is read at each communication point.
        act : callable, optional
            Called before each step, to set inputs of parts.

        Returns
        -------
        ndarray of shape (steps + 1, len(names))
        """
        rows = [self.read(names)]
        for _ in range(round(duration / self.step_length)):
            if act is not None:
                act(self)
            self.step()
            rows.append(self.read(names))
        return np.array(rows)

    def _pass(
        self, begin: Mapping[tuple[str, str], float], end: Mapping[tuple[str, str], float] | None
    ) -> dict[tuple[str, str], float]:
        """Step all parts from the present state; `end`: outputs at the end as a pass before found them."""
        now = dict(begin)
        for p in self._parts:
            first = np.array([begin[w.source, w.output] for w in p.wires])
            known = dict(now) if self.order == "in turn" else {}
            newest = np.array([(end or known or begin)[w.source, w.output] for w in p.wires])
            if p.wires:
                self._feed(p, first, newest, end is not None)
            p.fmu.step(self.time, self.step_length)
            now |= self._outputs(p)
        return now

    def _feed(self, p: _Part, first: Array, newest: Array, repeated: bool) -> None:
        """Inputs of a part over the step that follows: at its start, and as known at its end."""
        if p.set_slopes is None or self.inputs == "held":
            p.give(newest.tolist())
            return
        p.give(first.tolist())
        slope = (newest - first) / self.step_length
        if not repeated:  # of what is not known yet, as in the last step
            before = np.zeros_like(first) if p.last is None else (first - p.last) / self.step_length
            slope = np.where(newest == first, before, slope)
            p.last = first
        p.set_slopes(np.nan_to_num(slope, nan=0.0, posinf=0.0, neginf=0.0).tolist())

    def _outputs(self, p: _Part) -> dict[tuple[str, str], float]:
        values = p.read()
        for name, value in zip(p.outputs, values, strict=True):
            if not np.isfinite(value) and name not in p.told:
                p.told.add(name)
                self._own.append(f"{p.name}: at {self.time:.6g} s '{name}' is {value:g}. This is said once.")
        return {(p.name, name): value for name, value in zip(p.outputs, values, strict=True)}

    def _saved(self) -> _Saved:
        return _Saved([p.fmu for p in self._parts])


class _Saved:
    """States of FMUs while a step is made twice; what is called restores them."""

    def __init__(self, fmus: Sequence[Fmu]) -> None:
        self._fmus = fmus

    def __enter__(self) -> Callable[[], None]:
        self._states = [fmu.state() for fmu in self._fmus]
        return self._restore

    def _restore(self) -> None:
        for fmu, state in zip(self._fmus, self._states, strict=True):
            fmu.restore(state)

    def __exit__(self, *_: object) -> None:
        for fmu, state in zip(self._fmus, self._states, strict=True):
            fmu.free(state)


def _part(name: str, fmu: Fmu, wires: Sequence[Wire]) -> _Part:
    mine = tuple(w for w in wires if w.target == name)
    inputs = [w.input for w in mine]
    outputs = tuple(dict.fromkeys(w.output for w in wires if w.source == name))
    slopes = fmu.slope_setter(inputs) if fmu.follows_slopes and mine else None
    return _Part(name, fmu, mine, fmu.setter(inputs), slopes, outputs, fmu.getter(outputs))
