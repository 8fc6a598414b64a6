"""One instance of a co-simulation FMU, with the same methods for FMI 2.0 and 3.0."""

import ctypes
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, defaultCallbacks, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi3 import FMU3Slave, fmi3Byte
from fmpy.model_description import ModelDescription
from numpy.typing import NDArray

from ali3.call_mark import marked
from ali3.limits import at_most, raised
from ali3.message_text import clean, shortened
from ali3.processes import path_of_caller
from ali3.reading import LARGEST_STATE
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.scalars import ArrayValues, Scalar

_WARNING = 1
_MAX_RAW_MESSAGES = 256
_GUARD = bytes(range(1, 65))  # behind the buffer of a state, to detect writes beyond it
State: TypeAlias = ctypes.c_void_p
"""Pointer to a state in the memory of an FMU."""

# By version of FMI and type of a variable: the suffix of its functions, and its type in C.
_NUMBERS: dict[int, dict[str, tuple[str, Any]]] = {
    2: {"Real": ("Real", ctypes.c_double), **dict.fromkeys(("Integer", "Enumeration"), ("Integer", ctypes.c_int32))},
    3: {
        "Float64": ("Float64", ctypes.c_double),
        "Float32": ("Float32", ctypes.c_float),
        "Enumeration": ("Int64", ctypes.c_int64),
        **{
            f"{sign}Int{bits}": (f"{sign}Int{bits}", getattr(ctypes, f"c_{sign.lower()}int{bits}"))
            for sign in ("", "U")
            for bits in (8, 16, 32, 64)
        },
    },
}


class Instance:
    """An instance of an FMU of FMI 2.0 or 3.0; a call with an error status raises `FMICallException` of FMPy.

    `on_message`: called with status, category and text of each message; `token`: replaces the token of the description;
    `resources`: a location instead of that of the resources, a URI in FMI 2.0, a path in FMI 3.0.

    `is_fmi3`: whether the FMU follows FMI 3.0; `raw_messages`: the last messages as the FMU sent them;
    `incomplete_messages`: number of those without category or text; `set_inputs_at`: called with the times within the
    next step at which the FMU asks for inputs.
    """

    def __init__(
        self,
        description: ModelDescription,
        folder: Path,
        name: str,
        on_message: Callable[[int, str, str], None],
        token: str | None = None,
        resources: str | None = None,
    ) -> None:
        self.is_fmi3 = str(description.fmiVersion).startswith("3")
        self._update_error: Exception | None = None
        self._arrays = ArrayValues(description.modelVariables, self._read)
        self._on_message = on_message
        self.raw_messages: deque[str] = deque(maxlen=_MAX_RAW_MESSAGES)
        self._last_message, self._as_described = "", token is None and resources is None
        self.incomplete_messages = 0
        self.set_inputs_at: Callable[[float], None] | None = None
        slave_class = FMU3Slave if self.is_fmi3 else FMU2Slave
        self.slave: Any = _with_call_marks(
            marked("dlopen", slave_class)(
                guid=token or description.guid,
                unzipDirectory=str(folder),
                modelIdentifier=description.coSimulation.modelIdentifier,
                instanceName=clean(name),
            )
        )
        if resources is not None:
            self._replace_resources(resources.encode())
        self._instantiate(**(self._fmi3_callbacks(description) if self.is_fmi3 else self._fmi2_callbacks()))

    def _replace_resources(self, resources: bytes) -> None:
        """Instantiate with another location of the resources."""
        function, place = ("fmi3InstantiateCoSimulation", 2) if self.is_fmi3 else ("fmi2Instantiate", 3)
        instantiate = getattr(self.slave, function)
        setattr(self.slave, function, lambda *a: instantiate(*a[:place], resources, *a[place + 1 :]))

    def _fmi3_callbacks(self, description: ModelDescription) -> dict[str, Any]:
        inputs = inputs_within_steps(description)
        update = {"intermediateUpdate": self._intermediate_update, "requiredIntermediateVariables": inputs}
        return {"logMessage": self._log, **(update if inputs else {})}

    def _fmi2_callbacks(self) -> dict[str, Any]:
        self._callbacks = fmi2CallbackFunctions()  # must live as long as the instance
        self._callbacks.logger = fmi2CallbackLoggerTYPE(self._log)
        self._callbacks.allocateMemory = defaultCallbacks.allocateMemory
        self._callbacks.freeMemory = defaultCallbacks.freeMemory
        return {"callbacks": self._callbacks}

    def _log(self, environment: object, *rest: Any) -> None:
        """Store and pass on a message of the FMU; its last arguments are status, category and text."""
        *_, status, category, message = rest
        self.incomplete_messages += category is None or message is None
        text = (message or b"").decode("utf-8", "replace")
        self.raw_messages.append(text)
        if not self.is_fmi3:  # a printf format, in which # marks references
            text = text.replace("%%", "%").replace("##", "#")
        self._last_message = text
        self._on_message(int(status), (category or b"").decode("utf-8", "replace"), text)

    def _intermediate_update(self, environment: object, time: float, requested: bool, *rest: object) -> None:
        if requested and self.set_inputs_at is not None:
            try:
                self.set_inputs_at(time)
            except Exception as error:  # an exception must not pass through the FMU
                self._update_error, self.set_inputs_at = error, None

    def _instantiate(self, **functions: Any) -> None:
        try:
            self.slave.instantiate(**functions)
        except Exception as error:
            if not self._last_message and self._as_described:  # many FMUs state the reason only with logging on
                with suppress(Exception):
                    self.slave.instantiate(loggingOn=True, **functions)
                    self.slave.freeInstance()
            if any("enough memory" in text or "out of memory" in text.lower() for text in self.raw_messages):
                raise MemoryError from None
            raise HostError(": ".join(filter(None, (str(error), shortened(self._last_message))))) from None
        # PythonFMU 0.7 frees its interpreter twice when the library is closed; the instance holds its own reference.
        getattr(self.slave.dll, "finalizePythonInterpreter", int)()

    def initialise(
        self, start: Mapping[Scalar, Value], start_time: float = 0.0, stop_time: float | None = None
    ) -> None:
        """Set start values and leave initialisation mode."""
        if not self.is_fmi3:
            self.slave.setupExperiment(startTime=start_time, stopTime=stop_time)
        self.set(start)
        if self.is_fmi3:
            self.slave.enterInitializationMode(startTime=start_time, stopTime=stop_time)
        else:
            self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()

    def set(self, values: Mapping[Scalar, Value]) -> None:
        """Set variables of any type."""
        for kind in dict.fromkeys(scalar.type for scalar in values):
            rows: dict[int, list[Any]] = {}
            for scalar, value in values.items():
                if scalar.type == kind:
                    if scalar.reference not in rows:
                        rows[scalar.reference] = self._arrays.row(scalar)
                    rows[scalar.reference][scalar.index] = value
            getattr(self.slave, f"set{self._suffix(kind)}")(
                list(rows), [self._converter(kind)(value) for row in rows.values() for value in row]
            )
            self._arrays.keep(rows)  # values that were refused are not stored

    def _suffix(self, kind: str) -> str:
        """The suffix of the functions of a type."""
        return str(_NUMBERS[2 + self.is_fmi3].get(kind, (kind,))[0])

    def _converter(self, kind: str) -> Callable[[Any], Any]:
        if kind in ("Boolean", "String"):
            return _boolean if kind == "Boolean" else path_of_caller
        return float if self._suffix(kind) in ("Real", "Float64", "Float32") else int

    def _read(self, scalar: Scalar) -> list[Any]:
        """The values of an array in the FMU."""
        return list(getattr(self.slave, f"get{self._suffix(scalar.type)}")([scalar.reference], scalar.size))

    def reset(self) -> None:
        """Return to the state before `initialise`."""
        self.slave.reset()
        self._arrays.reset()

    def setter(self, scalars: Sequence[Scalar]) -> Callable[[Sequence[float]], None]:
        """A function that sets numbers; references and buffers are prepared once, except for elements of arrays."""
        if any(scalar.size > 1 for scalar in scalars):
            return lambda values: self.set(dict(zip(scalars, values, strict=True)))
        writes = []
        for kind, indices in _indices_by_type(scalars).items():
            call, references, buffer = self._prepare_call(
                "Set", kind, [scalars[k].reference for k in indices], len(indices)
            )
            writes.append((call, references, buffer, indices, self._converter(kind)))
        slave, counts = self.slave, self._value_counts

        def set_values(values: Sequence[float]) -> None:
            for call, references, buffer, indices, convert in writes:
                buffer[:] = [convert(values[k]) for k in indices]
                call(slave.component, references, len(references), buffer, *counts(buffer))

        return set_values

    def reader(self, scalars: Sequence[Scalar]) -> Callable[[NDArray[np.float64]], None]:
        """A function that writes numbers into an array; references and buffers are prepared once."""
        reads = []
        for kind, indices in _indices_by_type(scalars).items():
            sizes = {scalars[k].reference: scalars[k].size for k in indices}
            begin = dict(zip(sizes, np.cumsum([0, *sizes.values()]).tolist(), strict=False))
            call, references, buffer = self._prepare_call("Get", kind, list(sizes), sum(sizes.values()))
            source = np.array([begin[scalars[k].reference] + scalars[k].index for k in indices])
            reads.append(
                (
                    call,
                    references,
                    buffer,
                    np.ctypeslib.as_array(buffer),
                    _slice_or_array(np.array(indices)),
                    _slice_or_array(source),
                )
            )
        slave, counts = self.slave, self._value_counts

        def read_values(into: NDArray[np.float64]) -> None:
            for call, references, buffer, values, indices, source in reads:
                call(slave.component, references, len(references), buffer, *counts(buffer))
                into[indices] = values[source]

        return read_values

    def _prepare_call(
        self, verb: str, kind: str, references: Sequence[int], size: int
    ) -> tuple[Callable[..., int], Any, Any]:
        version = 2 + self.is_fmi3
        suffix, ctype = _NUMBERS[version][kind]
        call = getattr(self.slave, f"fmi{version}{verb}{suffix}")
        return call, (ctypes.c_uint32 * len(references))(*references), (ctype * size)()

    def _value_counts(self, buffer: Sequence[float]) -> tuple[int, ...]:
        """The number of values, which functions of FMI 3.0 take in addition."""
        return (len(buffer),) if self.is_fmi3 else ()

    def step(self, time: float, length: float) -> bool:
        """Make a communication step, s; whether the FMU then asks to end. `set_inputs_at` holds for this step."""
        self._update_error = None
        try:
            answer = self.slave.doStep(time, length)
        finally:
            self.set_inputs_at = None
        if self._update_error is not None:
            raise self._update_error
        return bool(answer[1]) if self.is_fmi3 else False

    def state(self) -> State:
        """The present state, to be freed by `free_state`."""
        saved: State = self.slave.getFMUState() if self.is_fmi3 else self.slave.getFMUstate()
        return saved

    def restore(self, state: State) -> None:
        """Continue from a state, which stays valid."""
        (self.slave.setFMUState if self.is_fmi3 else self.slave.setFMUstate)(state)
        self._arrays.forget()

    def free_state(self, state: State) -> None:
        """Free the memory of a state."""
        (self.slave.freeFMUState if self.is_fmi3 else self.slave.freeFMUstate)(state)

    def state_bytes(self) -> bytes:
        """The present state as bytes. Raises `HostError` if it is larger than a file of a state may be."""
        state, size = self.state(), ctypes.c_size_t()
        get_size = self.slave.fmi3SerializedFMUStateSize if self.is_fmi3 else self.slave.fmi2SerializedFMUstateSize
        try:
            get_size(self.slave.component, state, ctypes.byref(size))
            if size.value > raised(LARGEST_STATE):
                limit = at_most(size.value, LARGEST_STATE)
                raise HostError(f"The FMU says that its state has {size.value} bytes; it must have {limit}.")
            buffer = ctypes.create_string_buffer(bytes(size.value) + _GUARD, size.value + len(_GUARD))
            serialize = self.slave.fmi3SerializeFMUState if self.is_fmi3 else self.slave.fmi2SerializeFMUstate
            target = ctypes.cast(buffer, ctypes.POINTER(fmi3Byte)) if self.is_fmi3 else buffer
            serialize(self.slave.component, state, target, size)
            written = buffer.raw
            if written[size.value :] != _GUARD:
                raise HostError(f"The FMU writes more than the {size.value} bytes that it says its state has.")
            return written[: size.value]
        finally:
            self.free_state(state)

    def restore_bytes(self, content: bytes) -> None:
        """Continue from a state of `state_bytes`."""
        state = (self.slave.deserializeFMUState if self.is_fmi3 else self.slave.deSerializeFMUstate)(content)
        try:
            self.restore(state)
        finally:
            self.free_state(state)


def inputs_within_steps(description: ModelDescription) -> list[int]:
    """Value references of the real inputs that can be set within a step, by intermediate updates of FMI 3.0."""
    if not getattr(description.coSimulation, "providesIntermediateUpdate", False):
        return []
    return [
        v.valueReference
        for v in description.modelVariables
        if v.causality == "input" and v.type == "Real" and v.intermediateUpdate and not v.dimensions
    ]


def _with_call_marks(slave: Any) -> Any:
    """A slave of FMPy whose functions record the name of the present call, see `ali3.call_mark`."""
    for name in dir(slave):
        if name.startswith(("fmi2", "fmi3")):
            function = getattr(slave.dll, name)
            # Functions with a status are called directly, without the two Python frames of FMPy.
            call = _with_check(name, function) if function.restype is ctypes.c_int else getattr(slave, name)
            setattr(slave, name, marked(name, call))
    return slave


def _with_check(name: str, function: Callable[..., int]) -> Callable[..., int]:
    """A function of an FMU that raises `FMICallException` if its status is above a warning."""

    def call(*arguments: Any) -> int:
        status = function(*arguments)
        if status > _WARNING:
            raise FMICallException(function=name, status=status)
        return status

    return call


def _boolean(value: Any) -> bool:
    """The Boolean of a value or of a start value in a description."""
    return value.strip().lower() in ("true", "1") if isinstance(value, str) else bool(value)


def _slice_or_array(indices: NDArray[np.int64]) -> slice | NDArray[np.int64]:
    """Indices as a slice if they are consecutive, which is faster."""
    consecutive = bool((np.diff(indices) == 1).all())
    return slice(int(indices[0]), int(indices[-1]) + 1) if consecutive else indices


def _indices_by_type(scalars: Sequence[Scalar]) -> dict[str, list[int]]:
    kinds: dict[str, list[int]] = {}
    for k, scalar in enumerate(scalars):
        kinds.setdefault(scalar.type, []).append(k)
    return kinds
