"""An FMU opened through FMPy: names in place of value references, statuses and messages collected."""

from __future__ import annotations

import math
import shutil
import sys
import tempfile
import zipfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import TypeAlias

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import (
    FMU2Slave,
    defaultCallbacks,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
    fmi2ComponentEnvironment,
    fmi2FMUstate,
    fmi2Integer,
    fmi2Real,
    fmi2Status,
    fmi2ValueReference,
)
from fmpy.model_description import ModelDescription, ScalarVariable
from numpy.typing import NDArray

from ali3.files import reason
from ali3.running import command_name
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.variables import Variables

_NOT_COMPUTED = b"logNotComputed"

State: TypeAlias = "fmi2FMUstate"
"""A state that an FMU has saved, in its memory."""


class StepRefusedError(Exception):
    """The FMU refused a communication step."""


def described(path: Path) -> ModelDescription:
    """The description of an FMU of any version that FMPy reads.

    Parameters
    ----------
    path : Path

    Raises
    ------
    HostError
        It is no FMU that can be read.
    """
    if not path.is_file():
        if path.is_dir():
            raise HostError(f"{path} is a folder; an FMU is a file.")
        hint = f" Build it with: {command_name('build')}" if path.parent.name == "dist" else ""
        raise HostError(f"There is no file {path}.{hint}")
    if not zipfile.is_zipfile(path):
        raise HostError(f"{path} is not an FMU (not a zip archive).")
    try:
        return read_model_description(str(path))
    except ModuleNotFoundError:
        raise
    except Exception as error:
        raise HostError(f"{path} is not an FMU that can be read: {error}") from None


class Fmu:
    """One instance of a co-simulation FMU (FMI 2.0), ready to be initialised.

    Parameters
    ----------
    path : Path
        The FMU.

    Attributes
    ----------
    variables : dict of str to ScalarVariable
        By name, in the order of the model description.
    table : Variables
        The same as a person sets them.
    messages : list of str
        What the FMU logged at warning or above; not that an output is not computed: what opens it here reads all.
    """

    def __init__(self, path: Path) -> None:
        description = described(path)
        if description.fmiVersion != "2.0" or description.coSimulation is None:
            raise HostError(
                f"{path} is an FMU of FMI {description.fmiVersion}; this host drives FMI 2.0 co-simulation."
            )
        self.path = path
        self.description = description
        self.variables: dict[str, ScalarVariable] = {v.name: v for v in description.modelVariables}
        self.table = Variables(description)
        self.messages: list[str] = []
        self._folder = Path(tempfile.mkdtemp(prefix="fmu_"))
        self._callbacks = fmi2CallbackFunctions()
        self._logger = fmi2CallbackLoggerTYPE(self._log)
        self._callbacks.logger = self._logger
        self._callbacks.allocateMemory = defaultCallbacks.allocateMemory
        self._callbacks.freeMemory = defaultCallbacks.freeMemory
        try:
            extract(str(path), unzipdir=str(self._folder))
            self._slave = FMU2Slave(
                guid=description.guid,
                unzipDirectory=str(self._folder),
                modelIdentifier=description.coSimulation.modelIdentifier,
                instanceName=path.stem,
            )
            self._slave.instantiate(callbacks=self._callbacks)
        except BaseException as error:
            shutil.rmtree(self._folder, ignore_errors=True)
            if not isinstance(error, Exception):
                raise
            if isinstance(error, OSError) and error.errno is not None:
                raise HostError(f"{path} cannot be unpacked into {self._folder}: {reason(error)}.") from None
            raise HostError(f"{path} cannot be loaded on {sys.platform}: {self._last_message() or error}") from None

    def __enter__(self) -> Fmu:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._slave.freeInstance()
        shutil.rmtree(self._folder, ignore_errors=True)

    def names(self, causality: str) -> list[str]:
        """Names of the real and whole variables of a causality."""
        return [n for n, v in self.variables.items() if v.causality == causality and v.type in ("Real", "Integer")]

    @property
    def tunable(self) -> list[str]:
        """Names of the real and whole parameters that may be set between steps."""
        return [n for n in self.names("parameter") if self.variables[n].variability == "tunable"]

    def references(self, names: Iterable[str]) -> list[int]:
        """Value references of variables."""
        return [self.variables[n].valueReference for n in names]

    def initialise(self, start: Mapping[str, Value], start_time: float = 0.0) -> None:
        """Set start values and leave initialisation mode."""
        settable = {n for n, v in self.variables.items() if v.causality in ("parameter", "input")}
        for name in start:
            if name not in settable:
                near = ", ".join(sorted(settable)) or "none"
                raise HostError(f"The FMU has no parameter or input '{name}'; it has: {near}.")
        try:
            self._slave.setupExperiment(startTime=start_time)
            self._set(start)
            self._slave.enterInitializationMode()
            self._slave.exitInitializationMode()
        except FMICallException as error:
            raise HostError(f"The FMU could not be initialised: {self._last_message() or error}") from None

    def _set(self, values: Mapping[str, Value]) -> None:
        for kinds, call, kind in (
            (("Real",), self._slave.setReal, float),
            (("Integer", "Enumeration"), self._slave.setInteger, int),
            (("Boolean",), self._slave.setBoolean, bool),
            (("String",), self._slave.setString, str),
        ):
            found = {n: x for n, x in values.items() if self.variables[n].type in kinds}
            for name, value in found.items():
                if kind is int and not isinstance(value, str):
                    self._whole(name, value)
            if found:
                call(self.references(found), [kind(x) for x in found.values()])

    @staticmethod
    def _whole(name: str, value: float) -> int:
        if not (math.isfinite(value) and value == int(value)):
            raise HostError(f"'{name}' was set to {value:g}; it must be a whole number.")
        return int(value)

    def setter(self, names: Sequence[str]) -> Callable[[Sequence[float]], None]:
        """A function that sets variables; the references of real and whole ones are prepared once."""
        slave, kinds = self._slave, [self.variables[n].type for n in names]
        real, whole = ([k for k, kind in enumerate(kinds) if kind == wanted] for wanted in ("Real", "Integer"))
        others = [k for k, kind in enumerate(kinds) if kind not in ("Real", "Integer")]
        reals, buffer = (
            (fmi2ValueReference * len(real))(*self.references(names[k] for k in real)),
            (fmi2Real * len(real))(),
        )
        wholes = (fmi2ValueReference * len(whole))(*self.references(names[k] for k in whole))
        counts = (fmi2Integer * len(whole))()

        def set_values(values: Sequence[float]) -> None:
            try:
                if real:
                    buffer[:] = values if len(real) == len(kinds) else [values[k] for k in real]
                    slave.fmi2SetReal(slave.component, reals, len(real), buffer)
                if whole:
                    counts[:] = [self._whole(names[k], values[k]) for k in whole]
                    slave.fmi2SetInteger(slave.component, wholes, len(whole), counts)
                if others:
                    self._set({names[k]: values[k] for k in others})
            except FMICallException as error:
                raise HostError(f"An input was refused: {self._last_message() or error}") from None

        return set_values

    @property
    def follows_slopes(self) -> bool:
        """Whether inputs may change during a step, by derivatives that are set before it."""
        return self._can("canInterpolateInputs")

    def slope_setter(self, names: Sequence[str]) -> Callable[[Sequence[float]], None]:
        """A function that sets first derivatives by the time of real inputs, for the next step only."""
        slave, count = self._slave, len(names)
        references, orders = (fmi2ValueReference * count)(*self.references(names)), (fmi2Integer * count)(*count * [1])
        buffer = (fmi2Real * count)()

        def set_slopes(slopes: Sequence[float]) -> None:
            buffer[:] = slopes
            try:
                slave.fmi2SetRealInputDerivatives(slave.component, references, count, orders, buffer)
            except FMICallException as error:
                raise HostError(f"A derivative of an input was refused: {self._last_message() or error}") from None

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
        slave, kinds = self._slave, [self.variables[n].type for n in names]
        real, whole = ([k for k, kind in enumerate(kinds) if (kind == "Integer") == w] for w in (False, True))
        reals = (fmi2ValueReference * len(real))(*self.references(names[k] for k in real))
        wholes = (fmi2ValueReference * len(whole))(*self.references(names[k] for k in whole))
        buffer, counts = (fmi2Real * len(real))(), (fmi2Integer * len(whole))()
        values = np.ctypeslib.as_array(buffer)
        places = np.array(real) if whole else slice(None)

        def read_values(into: NDArray[np.float64]) -> None:
            if real:
                slave.fmi2GetReal(slave.component, reals, len(reals), buffer)
                into[places] = values
            if whole:
                slave.fmi2GetInteger(slave.component, wholes, len(wholes), counts)
                into[whole] = counts

        return read_values

    def step(self, time: float, step: float) -> None:
        """One communication step; `StepRefusedError` if the FMU refuses it."""
        try:
            self._slave.doStep(time, step)
        except FMICallException as error:
            raise StepRefusedError(self._last_message() or str(error)) from None

    def reset(self) -> None:
        """Back to before `initialise`, which then gives a new start."""
        try:
            self._slave.reset()
        except FMICallException as error:
            raise HostError(f"The FMU could not be reset: {self._last_message() or error}") from None

    def state(self) -> State:
        """The state now, to be given back by `free`; `HostError` if the FMU cannot save it."""
        self._check_states(self._can("canGetAndSetFMUstate"), "save its state")
        try:
            return self._slave.getFMUstate()
        except FMICallException as error:
            raise HostError(f"The FMU could not save its state: {self._last_message() or error}") from None

    def restore(self, state: State) -> None:
        """Go on from a state of `state`, which stays valid."""
        try:
            self._slave.setFMUstate(state)
        except FMICallException as error:
            raise HostError(f"The FMU could not restore a state: {self._last_message() or error}") from None

    def free(self, state: State) -> None:
        """Free the memory of a state."""
        self._slave.freeFMUstate(state)

    def state_bytes(self) -> bytes:
        """The state now as bytes, for a file or another process; `HostError` if the FMU cannot give it."""
        self._check_states(self._can("canSerializeFMUstate"), "write its state")
        state = self.state()
        try:
            content: bytes = self._slave.serializeFMUstate(state)
        except FMICallException as error:
            raise HostError(f"The FMU could not write its state: {self._last_message() or error}") from None
        finally:
            self.free(state)
        return content

    def restore_bytes(self, content: bytes) -> None:
        """Go on from a state of `state_bytes`; `HostError` if it is of another build or damaged."""
        self._check_states(self._can("canSerializeFMUstate"), "read a state")
        try:
            state = self._slave.deSerializeFMUstate(content)
        except FMICallException as error:
            raise HostError(f"The FMU refused a saved state: {self._last_message() or error}") from None
        try:
            self.restore(state)
        finally:
            self.free(state)

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
        constants = {n: v for n, v in self.variables.items() if v.variability == "constant" and v.type == "Real"}
        return {n: float(v.start) for n, v in constants.items()}

    def _last_message(self) -> str:
        return self.messages[-1] if self.messages else ""

    def _log(
        self,
        environment: fmi2ComponentEnvironment,
        name: bytes,
        status: fmi2Status,
        category: bytes,
        message: bytes,
    ) -> None:
        if status > 0 and message and category != _NOT_COMPUTED:
            self.messages.append(message.decode("utf-8", "replace"))
