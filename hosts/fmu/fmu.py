"""An FMU opened through FMPy: names in place of value references, statuses and messages collected."""

import math
import sys
import weakref
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from ctypes import c_double, c_int32, c_uint32
from pathlib import Path
from typing import Any

import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.model_description import ModelDescription, ScalarVariable
from numpy.typing import NDArray

from ali3.errors import reason
from ali3.message_text import brief, shortened
from ali3.near_names import did_you_mean
from ali3.processes import cause_text
from ali3.temporary_folder import temporary_folder
from hosts.common.closable import Closable
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.description_file import opened, read_description
from hosts.fmu.instance import Instance, State, inputs_within_steps
from hosts.fmu.scalars import TEXTS, NamedScalars, Place, constants_of
from hosts.fmu.variables import Variables, check_co_simulation

_MOST_MESSAGES = 10_000  # between two calls that clear them


class StepRefusedError(Exception):
    """The FMU refused a communication step."""


class StartRefusedError(HostError):
    """The FMU could not be initialised with these values."""


def described(path: Path) -> ModelDescription:
    """The description of an FMU with its scalars as variables; errors as of `read_description`."""
    return _read(path)[0]


def _read(path: Path) -> tuple[ModelDescription, dict[str, Place]]:
    description, variables, places = read_description(path)
    description.modelVariables = variables
    return description, places


def unpack(path: Path, folder: Path) -> None:
    """Unpack what an FMU runs with: all but its sources and documentation, which are most of its files."""
    with opened(path) as archive:
        archive.unpack(folder, lambda name: not name.startswith(("sources/", "documentation/")))


class Fmu(Closable, NamedScalars):
    """One instance of a co-simulation FMU (FMI 2.0 or 3.0), ready to be initialised.

    Its library is loaded by the first call that needs it: who asks for the description alone runs no foreign code.

    `variables`: scalars by name, in the order of the model description; types are those of FMI 2.0; `table`: the same
    as a person sets them; `messages`: what the FMU logged at warning or above; not that an output is not computed: what
    opens it here reads all.
    """

    def __init__(self, path: Path) -> None:
        description, self._places = _read(path)
        check_co_simulation(path, description)
        self.path, self.description = path, description
        self.variables: dict[str, ScalarVariable] = {v.name: v for v in description.modelVariables}
        self.table = Variables(description)
        self.messages: list[str] = []
        self._loaded: Instance | None = None
        self._begin = 0.0
        self._remove: weakref.finalize[..., Fmu] | None = None

    def load(self) -> Instance:
        """Load the library and make the instance, unless that is done. Raises `HostError`: that is not possible."""
        if self._loaded is not None:
            return self._loaded
        path = self.path
        stack = ExitStack()
        folder = stack.enter_context(temporary_folder())
        self._remove = weakref.finalize(self, stack.close)
        self._folder = folder
        try:
            unpack(path, folder)
            self._loaded = Instance(self.description, folder, path.stem, self._log)
        except BaseException as error:
            self._remove()
            if isinstance(error, MemoryError) or not isinstance(error, Exception):
                raise
            if isinstance(error, OSError) and error.errno is not None:
                raise HostError(f"{path} cannot be unpacked into {folder}: {reason(error)}.") from None
            raise HostError(f"{path} cannot be loaded on {sys.platform}: {error}{cause_text(error)}") from None
        return self._loaded

    @property
    def _instance(self) -> Instance:
        return self._loaded or self.load()

    @property
    def _slave(self) -> Any:
        return self._instance.slave

    def close(self) -> None:
        """Free the instance and what was unpacked, unless that is done."""
        if self._loaded is not None and self._remove is not None and self._remove.alive:
            self._loaded.slave.freeInstance()
            self._remove()

    def places(self, names: Iterable[str]) -> list[Place]:
        """Positions of the values of scalars."""
        return [self._places[n] for n in names]

    def initialise(self, start: Mapping[str, Value], start_time: float = 0.0) -> None:
        """Set start values and leave initialisation mode; `StartRefusedError` if the FMU cannot start with them."""
        settable = {n for n, v in self.variables.items() if v.causality in ("parameter", "input")}
        for name in start:
            if name not in settable:
                some = f"it has {len(settable)}, such as {', '.join(sorted(settable)[:6]) or 'none'}"
                raise HostError(f"The FMU has no parameter or input {brief(name)}{did_you_mean(name, settable, some)}")
        values = {self._places[name]: self._fitting(name, value) for name, value in start.items()}
        with self._errors_as("The FMU could not be initialised", StartRefusedError):
            self._instance.initialise(values, start_time)

    def _fitting(self, name: str, value: Value) -> Value:
        place = self._places[name]
        if place.size > 1 and place.type in TEXTS:
            raise HostError(
                f"'{name}' is one of {place.size} elements of an array of type {place.type}; such arrays keep the "
                "values of the FMU: FMI sets all elements at once, and the start values of the others are not known."
            )
        if isinstance(value, str) or self.variables[name].type not in ("Integer", "Enumeration"):
            return value
        return self._whole(name, value)

    @staticmethod
    def _whole(name: str, value: float) -> int:
        if not (math.isfinite(value) and value == int(value)):
            raise HostError(f"'{name}' was set to {value:g}; it must be a whole number.")
        return int(value)

    def setter(self, names: Sequence[str]) -> Callable[[Sequence[float]], None]:
        """A function that sets variables; the references of real and whole ones are prepared once."""
        kinds = [self.variables[n].type for n in names]
        numbers = [k for k, kind in enumerate(kinds) if kind in ("Real", "Integer")]
        whole_numbers = [k for k in numbers if kinds[k] == "Integer"]
        other_types = [k for k in range(len(kinds)) if k not in numbers]
        set_numbers = self._instance.setter(self.places(names[k] for k in numbers))

        def set_values(values: Sequence[float]) -> None:
            for k in whole_numbers:
                self._whole(names[k], values[k])
            further = {self._places[names[k]]: self._fitting(names[k], values[k]) for k in other_types}
            try:
                set_numbers([values[k] for k in numbers] if other_types else values)
                if further:
                    self._instance.set(further)
            except FMICallException as error:
                raise HostError(f"An input was refused: {self._last_message() or error}") from None

        return set_values

    @property
    def follows_slopes(self) -> bool:
        """Whether inputs may change during a step: by derivatives set before it, or as the FMU asks for them."""
        real = {self._places[n].reference for n in self.names("input") if self.variables[n].type == "Real"}
        return self._can("canInterpolateInputs") or bool(real and real <= {*inputs_within_steps(self.description)})

    def slope_setter(self, names: Sequence[str]) -> Callable[[Sequence[float]], None]:
        """A function that sets first derivatives by the time of real inputs, for the next step only."""
        if self._instance.three:
            return self._line_setter(names)
        slave, count = self._slave, len(names)
        references = (c_uint32 * count)(*(place.reference for place in self.places(names)))
        orders, buffer = (c_int32 * count)(*count * [1]), (c_double * count)()

        def set_slopes(slopes: Sequence[float]) -> None:
            buffer[:] = list(slopes)
            with self._errors_as("A derivative of an input was refused"):
                slave.fmi2SetRealInputDerivatives(slave.component, references, count, orders, buffer)

        return set_slopes

    def _line_setter(self, names: Sequence[str]) -> Callable[[Sequence[float]], None]:
        """The same in FMI 3.0: what is asked for within the step lies on lines from what is set."""
        instance, set_values, get_values = self._instance, self._instance.setter(self.places(names)), self.getter(names)

        def set_slopes(slopes: Sequence[float]) -> None:
            lines = list(zip(get_values(), slopes, strict=True))
            instance.follow = lambda time: set_values([x + rate * (time - self._begin) for x, rate in lines])

        return set_slopes

    def getter(self, names: Sequence[str]) -> Callable[[], list[float]]:
        """A function that gives the values of real and whole variables; see `reader`."""
        read_values, row = self.reader(names), np.empty(len(names))

        def get_values() -> list[float]:
            read_values(row)
            values: list[float] = row.tolist()
            return values

        return get_values

    def reader(self, names: Sequence[str]) -> Callable[[NDArray[np.float64]], None]:
        """A function that writes the values of real and whole variables into an array; references are prepared once."""
        return self._instance.reader(self.places(names))

    def step(self, time: float, step: float) -> None:
        """One communication step; `StepRefusedError` if the FMU refuses it."""
        self._begin = time
        try:
            ends = self._instance.step(time, step)
        except FMICallException as error:
            raise StepRefusedError(self._last_message() or str(error)) from None
        if ends:
            raise StepRefusedError("The FMU asks to end.")

    def reset(self) -> None:
        """Back to before `initialise`, which then gives a new start."""
        with self._errors_as("The FMU could not be reset"):
            self._instance.reset()

    def state(self) -> State:
        """The state now, to be given back by `free`; `HostError` if the FMU cannot save it."""
        self._check_states(self._can("canGetAndSetFMUstate"), "save its state")
        with self._errors_as("The FMU could not save its state"):
            return self._instance.state()

    def restore(self, state: State) -> None:
        """Go on from a state of `state`, which stays valid."""
        with self._errors_as("The FMU could not restore a state"):
            self._instance.restore(state)

    def free(self, state: State) -> None:
        """Free the memory of a state."""
        self._instance.free_state(state)

    def state_bytes(self) -> bytes:
        """The state now as bytes, for a file or another process; `HostError` if the FMU cannot give it."""
        self._check_states(self._can("canSerializeFMUstate"), "write its state")
        with self._errors_as("The FMU could not write its state"):
            return self._instance.state_bytes()

    def restore_bytes(self, content: bytes) -> None:
        """Go on from a state of `state_bytes`; `HostError` if it is of another build or damaged."""
        self._check_states(self._can("canSerializeFMUstate"), "read a state")
        with self._errors_as("The FMU refused a saved state"):
            self._instance.restore_bytes(content)

    def _can(self, flag: str) -> bool:
        return bool(getattr(self.description.coSimulation, flag, False))

    def _check_states(self, can: bool, what: str) -> None:
        if not can:
            raise HostError(f"{self.path.name} cannot {what}: its model description does not offer it.")

    def start_values(self, names: Iterable[str]) -> NDArray[np.float64]:
        """Start values from the model description, zero where there is none."""
        return np.array([float(self.variables[n].start or 0.0) for n in names])

    def constants(self) -> dict[str, float]:
        """Values of the constants, by name."""
        return constants_of(self.variables)

    @contextmanager
    def _errors_as(self, what: str, kind: type[HostError] = HostError) -> Iterator[None]:
        """A context that turns a refusal of the FMU into an error with its last message."""
        try:
            yield
        except FMICallException as error:
            raise kind(f"{what}: {self._last_message() or error}") from None

    def _last_message(self) -> str:
        return self.messages[-1] if self.messages else ""

    def _log(self, status: int, category: str, message: str) -> None:
        if status > 0 and message and category != "logNotComputed" and len(self.messages) < _MOST_MESSAGES:
            self.messages.append(shortened(message))
            if len(self.messages) == _MOST_MESSAGES:
                self.messages.append(f"The FMU has sent more than {_MOST_MESSAGES} messages; the others are left out.")
