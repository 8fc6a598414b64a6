"""FMUs that are stepped together: a small master for systems of a car and its partners."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ali3.message_text import brief
from ali3.near_names import did_you_mean
from hosts.common.arguments import positive, texts
from hosts.common.closable import Closable
from hosts.common.errors import HostError
from hosts.common.numbers import Value, is_finite
from hosts.fmu.fmu import Fmu, StepRefusedError
from hosts.systems.connections import Wire, fmus_of, part_and_name, starts_of, wires_of

Array = NDArray[np.float64]
Order = Literal["in turn", "at once"]
Inputs = Literal["held", "followed", "repeated"]
ORDERS = ("in turn", "at once")
INPUTS = ("held", "followed", "repeated")


@dataclass
class _Part:
    """A part with functions that read and set the variables of its wires."""

    name: str
    fmu: Fmu
    wires: tuple[Wire, ...]
    set_inputs: Callable[[Sequence[float]], None]
    set_slopes: Callable[[Sequence[float]], None] | None
    follows: NDArray[np.bool_]
    """Which wires end at real inputs, which may have slopes."""
    outputs: tuple[str, ...]
    read: Callable[[], list[float]]
    last: Array | None = None
    reported: set[str] = field(default_factory=set)


class CoupledFmus(Closable):
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
            raise HostError(f"order '{order}', inputs '{inputs}'; they must be among {ORDERS} and {INPUTS}.")
        self.step_length, self.order, self.inputs = positive(step, "The communication step", "s"), order, inputs
        self._steps, self._own_messages, self._state = 0, list[str](), "new"
        with ExitStack() as stack:
            fmus = fmus_of(parts, stack)
            wires = wires_of(connections, fmus)
            self._parts = [_part(name, fmu, wires) for name, fmu in fmus.items()]
            self._cannot_save = [n for n, f in fmus.items() if not f.description.coSimulation.canGetAndSetFMUstate]
            if inputs == "repeated" and self._cannot_save:
                raise HostError(
                    f"The part '{self._cannot_save[0]}' cannot save its state; its steps cannot be repeated."
                )
            self._stack = stack.pop_all()

    def close(self) -> None:
        """Free the instances."""
        self._stack.close()
        self._state = "closed"

    @property
    def time(self) -> float:
        """Time of the system, s."""
        return self._steps * self.step_length

    @property
    def messages(self) -> list[str]:
        """Messages of the parts, each with its part; those that a repeated step repeats only once."""
        return [f"{p.name}: {text}" for p in self._parts for text in dict.fromkeys(p.fmu.messages)] + self._own_messages

    def fmu(self, name: str) -> Fmu:
        """A part; inputs that no wire sets are set there."""
        fmus = self._fmus()
        if not isinstance(name, str) or name not in fmus:
            raise HostError(f"There is no part {brief(name)}{did_you_mean(str(name), fmus)}")
        return fmus[name]

    def initialise(self, **start: Value) -> None:
        """Start all parts at the time 0, each with the outputs of those before it; also again after steps.

        `start`: parameters and inputs as ``part.variable``. Raises `HostError`: there is no such part, or a part does
        not take its values.
        """
        by_part = starts_of(start, self._fmus())
        now: dict[tuple[str, str], float] = {}
        used, self._state = self._state != "new", "moved in part"
        for p in self._parts:
            if used:
                p.fmu.reset()
            p.last = None
            inputs = {w.input: now[w.source, w.output] for w in p.wires if (w.source, w.output) in now}
            p.fmu.initialise(inputs | by_part[p.name])
            now |= self._outputs(p, 0.0)
        self._now, self._steps, self._state = now, 0, "whole"

    def step(self) -> None:
        """A communication step of all parts.

        Raises `hosts.fmu.fmu.StepRefusedError` or `HostError`: a part refused it, or an input. Where all parts can save
        their states, they are then as before the step; else the system must be initialised again.
        """
        self._fmus()
        if self._state != "whole":
            raise HostError(
                "A system must be initialised before a step, and again after one that only some parts made."
            )
        lasts = [p.last for p in self._parts]
        with _saved([] if self._cannot_save else [p.fmu for p in self._parts]) as restore:
            try:
                now = self._step_parts(self._now, None)
                if self.inputs == "repeated":
                    restore()
                    now = self._step_parts(self._now, now)
            except (StepRefusedError, HostError) as error:
                self._state = "moved in part"
                if self._cannot_save:
                    raise type(error)(
                        f"{error} The system cannot continue, because the part '{self._cannot_save[0]}' cannot "
                        "save its state; initialise it again."
                    ) from None
                restore()
                for p, last in zip(self._parts, lasts, strict=True):
                    p.last = last
                self._state = "whole"
                raise type(error)(f"{error} All parts are back at {self.time:.6g} s.") from None
        self._now = now
        self._steps += 1

    def read(self, names: Sequence[str]) -> Array:
        """Values of variables now, each named as ``part.variable``; shape (len(names),)."""
        return self._reader(names)()

    def run(self, duration: float, names: Sequence[str], act: Callable[[CoupledFmus], None] | None = None) -> Array:
        """Step the system for a time.

        `duration`: a whole number of communication steps, s; `names`: what is read at each communication point; `act`:
        called before each step, to set inputs of parts. Raises `hosts.fmu.fmu.StepRefusedError` or `HostError` as of
        `step`; or the time is not a whole number of steps. Returns an array of shape (steps + 1, len(names)).
        """
        steps = duration / self.step_length if is_finite(duration) else np.nan
        if not (0.0 <= steps < np.inf and abs(steps - round(steps)) < 1e-6 * max(steps, 1.0)):
            raise HostError(
                f"A run of {brief(duration)} s is {steps:.6g} communication steps of {self.step_length:g} s; "
                "it must be a whole number of them."
            )
        read = self._reader(names)
        rows = [read()]
        for _ in range(round(steps)):
            if act is not None:
                act(self)
            self.step()
            rows.append(read())
        return np.array(rows)

    def _fmus(self) -> dict[str, Fmu]:
        """The parts by name. Raises `HostError`: the system is closed."""
        if self._state == "closed":
            raise HostError("The system is closed; make another one.")
        return {p.name: p.fmu for p in self._parts}

    def _reader(self, names: Sequence[str]) -> Callable[[], Array]:
        """A function that reads variables."""
        fmus = self._fmus()
        if self._state == "new":
            raise HostError("A system must be initialised before its values are read.")
        getters = []
        for text in texts(names, "The variables"):
            part, name = part_and_name(text, fmus)
            variables = fmus[part].variables
            if name not in variables or variables[name].type not in ("Real", "Integer"):
                numbers = [n for n, v in variables.items() if v.type in ("Real", "Integer")]
                raise HostError(f"The part '{part}' has no number '{name}'{did_you_mean(name, numbers)}")
            getters.append(fmus[part].getter([name]))
        return lambda: np.array([get()[0] for get in getters])

    def _step_parts(
        self, begin: Mapping[tuple[str, str], float], end: Mapping[tuple[str, str], float] | None
    ) -> dict[tuple[str, str], float]:
        """Step all parts from the present state. `end`: outputs at the end of the step, from an earlier pass."""
        now, end_time, stepped = dict(begin), (self._steps + 1) * self.step_length, set[str]()
        for p in self._parts:
            first = np.array([begin[w.source, w.output] for w in p.wires])
            current = dict(now) if self.order == "in turn" else {}
            known_ends = [end if follows else None for follows in p.follows]
            newest = np.array(
                [(e or current or begin)[w.source, w.output] for e, w in zip(known_ends, p.wires, strict=True)]
            )
            is_end_known = [end is not None or (w.source in stepped and self.order == "in turn") for w in p.wires]
            try:
                if p.wires:
                    self._set_inputs(p, first, newest, np.array(is_end_known), end is not None)
                p.fmu.step(self.time, self.step_length)
            except (StepRefusedError, HostError) as error:
                raise type(error)(f"The part '{p.name}' refused the step from {self.time:.6g} s: {error}") from None
            stepped.add(p.name)
            now |= self._outputs(p, end_time)
        return now

    def _set_inputs(
        self, p: _Part, first: Array, newest: Array, is_end_known: NDArray[np.bool_], repeated: bool
    ) -> None:
        """Set the inputs of a part for the next step, with slopes if it follows them."""
        if p.set_slopes is None or self.inputs == "held":
            p.set_inputs(newest.tolist())
            return
        p.set_inputs(np.where(p.follows, first, newest).tolist())
        before = np.zeros_like(first) if p.last is None else first - p.last
        slope = np.where(is_end_known, newest - first, before) / self.step_length
        if not repeated:
            p.last = first
        p.set_slopes(np.nan_to_num(slope[p.follows], nan=0.0, posinf=0.0, neginf=0.0).tolist())

    def _outputs(self, p: _Part, time: float) -> dict[tuple[str, str], float]:
        values = p.read()
        for name, value in zip(p.outputs, values, strict=True):
            if not np.isfinite(value) and name not in p.reported:
                p.reported.add(name)
                self._own_messages.append(f"{p.name}: at {time:.6g} s '{name}' is {value:g}. This is reported once.")
        return {(p.name, name): value for name, value in zip(p.outputs, values, strict=True)}


@contextmanager
def _saved(fmus: Sequence[Fmu]) -> Iterator[Callable[[], None]]:
    """A context with saved states of FMUs; yields a function that restores them."""
    with ExitStack() as stack:
        states = []
        for fmu in fmus:
            states.append((fmu, fmu.state()))
            stack.callback(fmu.free, states[-1][1])

        def restore() -> None:
            for fmu, state in states:
                fmu.restore(state)

        yield restore


def _part(name: str, fmu: Fmu, wires: Sequence[Wire]) -> _Part:
    incoming = tuple(w for w in wires if w.target == name)
    inputs = [w.input for w in incoming]
    outputs = tuple(dict.fromkeys(w.output for w in wires if w.source == name))
    real = [i for i in inputs if fmu.variables[i].type == "Real"]
    follows = np.array([i in real for i in inputs], bool)
    slopes = fmu.slope_setter(real) if fmu.follows_slopes and real else None
    return _Part(name, fmu, incoming, fmu.setter(inputs), slopes, follows, outputs, fmu.getter(outputs))
