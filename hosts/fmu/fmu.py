"""An FMU opened through FMPy: names instead of value references, statuses and messages collected."""

import math
import sys
import weakref
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from ctypes import c_double, c_int32, c_uint32
from pathlib import Path
from shlex import quote
from typing import Any

import numpy as np
from fmpy import platform, platform_tuple
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
from hosts.fmu.scalars import TEXTS, NamedScalars, Scalar, constants_of
from hosts.fmu.variables import Variables, check_co_simulation

_MAX_MESSAGES = 10_000  # until the list is cleared


class StepRefusedError(Exception):
    """The FMU refused a communication step."""


class StartRefusedError(HostError):
    """The FMU could not be initialised with these values."""


def described(path: Path) -> ModelDescription:
    """The description of an FMU with its scalars as variables; errors: see `read_description`."""
    return _read_with_addresses(path)[0]


def _read_with_addresses(path: Path) -> tuple[ModelDescription, dict[str, Scalar]]:
    description, variables, addresses = read_description(path)
    description.modelVariables = variables
    return description, addresses


def unpack(path: Path, folder: Path) -> None:
    """Unpack an FMU without its sources and documentation, which are most of its files and are not needed to run it."""
    with opened(path) as archive:
        archive.unpack(folder, lambda name: not name.startswith(("sources/", "documentation/")))


class Fmu(Closable, NamedScalars):
    """One instance of a co-simulation FMU (FMI 2.0 or 3.0), ready to be initialised.

    The library is loaded by the first call that needs it; reading the description runs no code of the FMU.

    `variables`: scalars by name, in the order of the model description, with types of FMI 2.0; `table`: the same with
    ranges and units, as a user sets them; `messages`: those of the FMU at warning or above, except that an output was
    not computed, because hosts here read all outputs.
    """

    def __init__(self, path: Path) -> None:
        description, self._scalars = _read_with_addresses(path)
        check_co_simulation(path, description)
        self.path, self.description = path, description
        self.variables: dict[str, ScalarVariable] = {v.name: v for v in description.modelVariables}
        self.table = Variables(description)
        self.messages: list[str] = []
        self._loaded: Instance | None = None
        self._step_begin = 0.0
        self._remove: weakref.finalize[..., Fmu] | None = None

    def load(self) -> Instance:
        """Load the library and instantiate the FMU unless it is loaded. Raises `HostError` if it cannot be loaded."""
        if self._loaded is not None:
            return self._loaded
        path = self.path
        stack = ExitStack()
        folder = stack.enter_context(temporary_folder())
        self._remove = weakref.finalize(self, stack.close)
        self._folder = folder
        try:
            unpack(path, folder)
            self._check_platform(folder)
            self._loaded = Instance(self.description, folder, path.stem, self._log)
        except BaseException as error:
            self._remove()
            if isinstance(error, MemoryError) or not isinstance(error, Exception):
                raise
            if isinstance(error, OSError) and error.errno is not None:
                raise HostError(f"{path} cannot be unpacked into {folder}: {reason(error)}.") from None
            raise HostError(f"{path} cannot be loaded on {sys.platform}: {error}{cause_text(error)}") from None
        return self._loaded

    def _check_platform(self, folder: Path) -> None:
        """Raise `HostError` if the unpacked FMU has no library for this platform."""
        own = platform_tuple if self.description.fmiVersion.startswith("3") else platform
        if (folder / "binaries" / own).is_dir():
            return
        others = ", ".join(sorted({file.parent.name for file in folder.glob("binaries/*/*")}))
        raise HostError(
            f"it has no library for {own}; it has {'those for ' if others else ''}{others or 'none'}. To an "
            f"FMU that ALi3 has built, ali3 build --fmu {quote(str(self.path))} --platforms this --out "
            f"{quote(str(self.path.parent))} adds it."
        )

    @property
    def _instance(self) -> Instance:
        return self._loaded or self.load()

    @property
    def _slave(self) -> Any:
        return self._instance.slave

    def close(self) -> None:
        """Free the instance and remove the unpacked files, if they are there."""
        if self._loaded is not None and self._remove is not None and self._remove.alive:
            self._loaded.slave.freeInstance()
            self._remove()

    def scalars(self, names: Iterable[str]) -> list[Scalar]:
        """The addresses of scalars."""
        return [self._scalars[n] for n in names]

    def initialise(self, start: Mapping[str, Value], start_time: float = 0.0) -> None:
        """Set start values and leave initialisation mode; `StartRefusedError` if the FMU cannot start with them."""
        settable = {n for n, v in self.variables.items() if v.causality in ("parameter", "input")}
        for name in start:
            if name not in settable:
                hint = f"it has {len(settable)}, such as {', '.join(sorted(settable)[:6]) or 'none'}"
                raise HostError(f"The FMU has no parameter or input {brief(name)}{did_you_mean(name, settable, hint)}")
        values = {self._scalars[name]: self._checked(name, value) for name, value in start.items()}
        with self._host_errors("The FMU could not be initialised", StartRefusedError):
            self._instance.initialise(values, start_time)

    def _checked(self, name: str, value: Value) -> Value:
        scalar = self._scalars[name]
        if scalar.size > 1 and scalar.type in TEXTS:
            raise HostError(
                f"'{name}' is one of {scalar.size} elements of an array of type {scalar.type}; such arrays keep the "
                "values of the FMU: FMI sets all elements at once, and the start values of the others are not known."
            )
        if isinstance(value, str) or self.variables[name].type not in ("Integer", "Enumeration"):
            return value
        return self._integer(name, value)

    @staticmethod
    def _integer(name: str, value: float) -> int:
        if not (math.isfinite(value) and value == int(value)):
            raise HostError(f"'{name}' was set to {value:g}; it must be a whole number.")
        return int(value)

    def setter(self, names: Sequence[str]) -> Callable[[Sequence[float]], None]:
        """A function that sets variables; references of real and integer ones are prepared once."""
        kinds = [self.variables[n].type for n in names]
        numbers = [k for k, kind in enumerate(kinds) if kind in ("Real", "Integer")]
        integers = [k for k in numbers if kinds[k] == "Integer"]
        other_types = [k for k in range(len(kinds)) if k not in numbers]
        set_numbers = self._instance.setter(self.scalars(names[k] for k in numbers))

        def set_values(values: Sequence[float]) -> None:
            for k in integers:
                self._integer(names[k], values[k])
            other_values = {self._scalars[names[k]]: self._checked(names[k], values[k]) for k in other_types}
            try:
                set_numbers([values[k] for k in numbers] if other_types else values)
                if other_values:
                    self._instance.set(other_values)
            except FMICallException as error:
                raise HostError(f"An input was refused: {self._last_message() or error}") from None

        return set_values

    @property
    def follows_slopes(self) -> bool:
        """Whether inputs may change during a step: by their derivatives, or by intermediate updates of FMI 3.0."""
        real = {self._scalars[n].reference for n in self.names("input") if self.variables[n].type == "Real"}
        return self._has_capability("canInterpolateInputs") or bool(
            real and real <= {*inputs_within_steps(self.description)}
        )

    def slope_setter(self, names: Sequence[str]) -> Callable[[Sequence[float]], None]:
        """A function that sets first time derivatives of real inputs for the next step."""
        if self._instance.is_fmi3:
            return self._interpolating_setter(names)
        slave, count = self._slave, len(names)
        references = (c_uint32 * count)(*(scalar.reference for scalar in self.scalars(names)))
        orders, buffer = (c_int32 * count)(*count * [1]), (c_double * count)()

        def set_slopes(slopes: Sequence[float]) -> None:
            buffer[:] = list(slopes)
            with self._host_errors("A derivative of an input was refused"):
                slave.fmi2SetRealInputDerivatives(slave.component, references, count, orders, buffer)

        return set_slopes

    def _interpolating_setter(self, names: Sequence[str]) -> Callable[[Sequence[float]], None]:
        """The same in FMI 3.0: intermediate updates interpolate linearly from the values at the start of the step."""
        instance, set_values, get_values = (
            self._instance,
            self._instance.setter(self.scalars(names)),
            self.getter(names),
        )

        def set_slopes(slopes: Sequence[float]) -> None:
            lines = list(zip(get_values(), slopes, strict=True))
            instance.set_inputs_at = lambda time: set_values(
                [x + rate * (time - self._step_begin) for x, rate in lines]
            )

        return set_slopes

    def getter(self, names: Sequence[str]) -> Callable[[], list[float]]:
        """A function that returns the values of real and integer variables; see `reader`."""
        read_values, row = self.reader(names), np.empty(len(names))

        def get_values() -> list[float]:
            read_values(row)
            values: list[float] = row.tolist()
            return values

        return get_values

    def reader(self, names: Sequence[str]) -> Callable[[NDArray[np.float64]], None]:
        """A function that writes values of real and integer variables into an array; references are prepared once."""
        return self._instance.reader(self.scalars(names))

    def step(self, time: float, step: float) -> None:
        """Make a communication step; `StepRefusedError` if the FMU refuses it. `time`, `step`: s."""
        self._step_begin = time
        try:
            ends = self._instance.step(time, step)
        except FMICallException as error:
            raise StepRefusedError(self._last_message() or str(error)) from None
        if ends:
            raise StepRefusedError("The FMU asks to end.")

    def reset(self) -> None:
        """Return to the state before `initialise`."""
        with self._host_errors("The FMU could not be reset"):
            self._instance.reset()

    def state(self) -> State:
        """The present state, to be freed by `free`; `HostError` if the FMU cannot save it."""
        self._check_states(self._has_capability("canGetAndSetFMUstate"), "save its state")
        with self._host_errors("The FMU could not save its state"):
            return self._instance.state()

    def restore(self, state: State) -> None:
        """Continue from a state of `state`, which stays valid."""
        with self._host_errors("The FMU could not restore a state"):
            self._instance.restore(state)

    def free(self, state: State) -> None:
        """Free the memory of a state."""
        self._instance.free_state(state)

    def state_bytes(self) -> bytes:
        """The present state as bytes, for a file or another process; `HostError` if the FMU cannot serialize it."""
        self._check_states(self._has_capability("canSerializeFMUstate"), "write its state")
        with self._host_errors("The FMU could not write its state"):
            return self._instance.state_bytes()

    def restore_bytes(self, content: bytes) -> None:
        """Continue from a state of `state_bytes`; `HostError` if it is of another build or damaged."""
        self._check_states(self._has_capability("canSerializeFMUstate"), "read a state")
        with self._host_errors("The FMU refused a saved state"):
            self._instance.restore_bytes(content)

    def _has_capability(self, flag: str) -> bool:
        return bool(getattr(self.description.coSimulation, flag, False))

    def _check_states(self, is_possible: bool, action: str) -> None:
        if not is_possible:
            raise HostError(f"{self.path.name} cannot {action}: its model description does not offer it.")

    def start_values(self, names: Iterable[str]) -> NDArray[np.float64]:
        """Start values from the model description, zero if there is none."""
        return np.array([float(self.variables[n].start or 0.0) for n in names])

    def constants(self) -> dict[str, float]:
        """Values of the constants, by name."""
        return constants_of(self.variables)

    @contextmanager
    def _host_errors(self, failure: str, kind: type[HostError] = HostError) -> Iterator[None]:
        """A context that turns an FMI error into a `HostError` with the last message of the FMU."""
        try:
            yield
        except FMICallException as error:
            raise kind(f"{failure}: {self._last_message() or error}") from None

    def _last_message(self) -> str:
        return self.messages[-1] if self.messages else ""

    def _log(self, status: int, category: str, message: str) -> None:
        if status > 0 and message and category != "logNotComputed" and len(self.messages) < _MAX_MESSAGES:
            self.messages.append(shortened(message))
            if len(self.messages) == _MAX_MESSAGES:
                self.messages.append(f"The FMU has sent more than {_MAX_MESSAGES} messages; the others are left out.")
