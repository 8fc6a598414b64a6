"""One instance of a co-simulation FMU behind the same calls for FMI 2.0 and 3.0."""

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
from ali3.message_text import shortened
from ali3.processes import path_of_caller
from ali3.reading import LARGEST_STATE
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.array_values import ArrayValues
from hosts.fmu.scalars import Place

_WARNING = 1
_KEPT = 256  # messages
_GUARD = bytes(range(1, 65))  # behind what an FMU writes
State: TypeAlias = ctypes.c_void_p
"""A state that an FMU has saved, in its memory."""

# By the version of FMI and the type of a variable: the end of the names of its functions, and the type in C.
_NUMBERS: dict[int, dict[str, tuple[str, Any]]] = {
    2: {
        "Real": ("Real", ctypes.c_double),
        **dict.fromkeys(("Integer", "Enumeration"), ("Integer", ctypes.c_int32)),
    },
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
    """An instance of an FMU of FMI 2.0 or 3.0; what FMI refuses is an `FMICallException` of FMPy.

    `told`: takes status, category and text of each message; `token`: in place of that of the description; `resources`:
    their location in place of the right one, of FMI 2.0 a URI, of FMI 3.0 a path. `three`: whether it is FMI 3.0;
    `raw`: the last messages as the FMU gave them; `without_text`: how many had no category or text; `follow`: called
    with the times within the next step at which an FMU asks for inputs.
    """

    def __init__(
        self,
        description: ModelDescription,
        folder: Path,
        name: str,
        told: Callable[[int, str, str], None],
        token: str | None = None,
        resources: str | None = None,
    ) -> None:
        self.three = str(description.fmiVersion).startswith("3")
        self._failed: Exception | None = None
        self._arrays = ArrayValues(description.modelVariables, self._read)
        arguments: dict[str, Any] = {
            "guid": token or description.guid,
            "unzipDirectory": str(folder),
            "modelIdentifier": description.coSimulation.modelIdentifier,
            "instanceName": name,
        }

        self.raw: deque[str] = deque(maxlen=_KEPT)
        self._last, self._as_described = "", token is None and resources is None
        self.without_text = 0

        def log(environment: object, *rest: Any) -> None:
            *_, status, category, message = rest
            self.without_text += category is None or message is None
            text = (message or b"").decode("utf-8", "replace")
            self.raw.append(text)
            if not self.three:  # a format of printf, in which # marks references
                text = text.replace("%%", "%").replace("##", "#")
            self._last = text
            told(int(status), (category or b"").decode("utf-8", "replace"), text)

        self.follow: Callable[[float], None] | None = None
        if self.three:
            self.slave: Any = _marked(marked("dlopen", FMU3Slave)(**arguments))
            if resources is not None:
                three = self.slave.fmi3InstantiateCoSimulation
                self.slave.fmi3InstantiateCoSimulation = lambda *a: three(*a[:2], resources.encode(), *a[3:])
            requested = inputs_within_steps(description)
            within = (
                {"intermediateUpdate": self._update, "requiredIntermediateVariables": requested} if requested else {}
            )
            self._instantiate(logMessage=log, **within)
            return
        self.slave = _marked(marked("dlopen", FMU2Slave)(**arguments))
        self._callbacks = fmi2CallbackFunctions()
        self._callbacks.logger = fmi2CallbackLoggerTYPE(log)
        self._callbacks.allocateMemory = defaultCallbacks.allocateMemory
        self._callbacks.freeMemory = defaultCallbacks.freeMemory
        if resources is not None:
            take = self.slave.fmi2Instantiate
            self.slave.fmi2Instantiate = lambda *a: take(*a[:3], resources.encode(), *a[4:])
        self._instantiate(callbacks=self._callbacks)

    def _update(self, environment: object, time: float, requested: bool, *rest: object) -> None:
        if requested and self.follow is not None:
            try:
                self.follow(time)
            except Exception as error:  # none goes through the FMU
                self._failed, self.follow = error, None

    def _instantiate(self, **functions: Any) -> None:
        try:
            self.slave.instantiate(**functions)
        except Exception as error:
            if not self._last and self._as_described:  # many say why only where logging is on
                with suppress(Exception):
                    self.slave.instantiate(loggingOn=True, **functions)
                    self.slave.freeInstance()
            if any("enough memory" in text or "out of memory" in text.lower() for text in self.raw):
                raise MemoryError from None
            raise HostError(": ".join(filter(None, (str(error), shortened(self._last))))) from None
        # PythonFMU 0.7 frees its own record of Python twice when the library is closed; the instance keeps its share.
        getattr(self.slave.dll, "finalizePythonInterpreter", int)()

    def initialise(self, start: Mapping[Place, Value], start_time: float = 0.0, stop_time: float | None = None) -> None:
        """Set start values and leave initialisation mode."""
        if not self.three:
            self.slave.setupExperiment(startTime=start_time, stopTime=stop_time)
        self.set(start)
        if self.three:
            self.slave.enterInitializationMode(startTime=start_time, stopTime=stop_time)
        else:
            self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()

    def set(self, values: Mapping[Place, Value]) -> None:
        """Set variables of any type."""
        for kind in dict.fromkeys(place.type for place in values):
            results: dict[int, list[Any]] = {}
            for place, value in values.items():
                if place.type == kind:
                    if place.reference not in results:
                        results[place.reference] = self._arrays.row(place)
                    results[place.reference][place.item] = value
            getattr(self.slave, f"set{self._suffix(kind)}")(
                list(results), [self._type(kind)(value) for row in results.values() for value in row]
            )
            self._arrays.keep(results)  # nothing of what was refused

    def _suffix(self, kind: str) -> str:
        """The end of the names of the functions of a type."""
        return str(_NUMBERS[2 + self.three].get(kind, (kind,))[0])

    def _type(self, kind: str) -> Callable[[Any], Any]:
        if kind in ("Boolean", "String"):
            return _truth if kind == "Boolean" else path_of_caller
        return float if self._suffix(kind) in ("Real", "Float64", "Float32") else int

    def _read(self, place: Place) -> list[Any]:
        """The values of an array as the FMU has them."""
        return list(getattr(self.slave, f"get{self._suffix(place.type)}")([place.reference], place.size))

    def reset(self) -> None:
        """Back to before `initialise`."""
        self.slave.reset()
        self._arrays.reset()

    def setter(self, places: Sequence[Place]) -> Callable[[Sequence[float]], None]:
        """A function that sets numbers; without elements of arrays references and buffers are prepared once."""
        if any(place.size > 1 for place in places):
            return lambda values: self.set(dict(zip(places, values, strict=True)))
        writes = []
        for kind, indices in _by_type(places).items():
            call, references, buffer = self._prepared("Set", kind, [places[k].reference for k in indices], len(indices))
            writes.append((call, references, buffer, indices, self._type(kind)))
        slave, counts = self.slave, self._counts

        def set_values(values: Sequence[float]) -> None:
            for call, references, buffer, indices, of in writes:
                buffer[:] = [of(values[k]) for k in indices]
                call(slave.component, references, len(references), buffer, *counts(buffer))

        return set_values

    def reader(self, places: Sequence[Place]) -> Callable[[NDArray[np.float64]], None]:
        """A function that writes numbers into an array; references and buffers are prepared once."""
        reads = []
        for kind, indices in _by_type(places).items():
            sizes = {places[k].reference: places[k].size for k in indices}
            begin = dict(zip(sizes, np.cumsum([0, *sizes.values()]).tolist(), strict=False))
            call, references, buffer = self._prepared("Get", kind, list(sizes), sum(sizes.values()))
            source = np.array([begin[places[k].reference] + places[k].item for k in indices])
            reads.append(
                (call, references, buffer, np.ctypeslib.as_array(buffer), _span(np.array(indices)), _span(source))
            )
        slave, counts = self.slave, self._counts

        def read_values(into: NDArray[np.float64]) -> None:
            for call, references, buffer, values, indices, source in reads:
                call(slave.component, references, len(references), buffer, *counts(buffer))
                into[indices] = values[source]

        return read_values

    def _prepared(
        self, verb: str, kind: str, references: Sequence[int], size: int
    ) -> tuple[Callable[..., int], Any, Any]:
        version = 2 + self.three
        suffix, ctype = _NUMBERS[version][kind]
        call = getattr(self.slave, f"fmi{version}{verb}{suffix}")
        return call, (ctypes.c_uint32 * len(references))(*references), (ctype * size)()

    def _counts(self, buffer: Sequence[float]) -> tuple[int, ...]:
        """What FMI 3.0 asks for too: the number of values."""
        return (len(buffer),) if self.three else ()

    def step(self, time: float, length: float) -> bool:
        """A communication step; whether the FMU then asks to end. What `follow` sets holds for this step."""
        self._failed = None
        try:
            answer = self.slave.doStep(time, length)
        finally:
            self.follow = None
        if self._failed is not None:
            raise self._failed
        return bool(answer[1]) if self.three else False

    def state(self) -> State:
        """The state now, to be given back by `free_state`."""
        saved: State = self.slave.getFMUState() if self.three else self.slave.getFMUstate()
        return saved

    def restore(self, state: State) -> None:
        """Go on from a state, which stays valid."""
        (self.slave.setFMUState if self.three else self.slave.setFMUstate)(state)
        self._arrays.forget()

    def free_state(self, state: State) -> None:
        """Free the memory of a state."""
        (self.slave.freeFMUState if self.three else self.slave.freeFMUstate)(state)

    def state_bytes(self) -> bytes:
        """The state now as bytes. Raises `HostError`: it is larger than files of states may be."""
        state, size = self.state(), ctypes.c_size_t()
        measure = self.slave.fmi3SerializedFMUStateSize if self.three else self.slave.fmi2SerializedFMUstateSize
        try:
            measure(self.slave.component, state, ctypes.byref(size))
            if size.value > raised(LARGEST_STATE):
                limit = at_most(size.value, LARGEST_STATE)
                raise HostError(f"The FMU says that its state has {size.value} bytes; it must have {limit}.")
            room = ctypes.create_string_buffer(bytes(size.value) + _GUARD, size.value + len(_GUARD))
            write = self.slave.fmi3SerializeFMUState if self.three else self.slave.fmi2SerializeFMUstate
            block = ctypes.cast(room, ctypes.POINTER(fmi3Byte)) if self.three else room
            write(self.slave.component, state, block, size)
            written = room.raw
            if written[size.value :] != _GUARD:
                raise HostError(f"The FMU writes more than the {size.value} bytes that it says its state has.")
            return written[: size.value]
        finally:
            self.free_state(state)

    def restore_bytes(self, content: bytes) -> None:
        """Go on from a state of `state_bytes`."""
        state = (self.slave.deserializeFMUState if self.three else self.slave.deSerializeFMUstate)(content)
        try:
            self.restore(state)
        finally:
            self.free_state(state)


def inputs_within_steps(description: ModelDescription) -> list[int]:
    """Value references of the real inputs that can be set within a step, in FMI 3.0 by its intermediate update."""
    if not getattr(description.coSimulation, "providesIntermediateUpdate", False):
        return []
    return [
        v.valueReference
        for v in description.modelVariables
        if v.causality == "input" and v.type == "Real" and v.intermediateUpdate and not v.dimensions
    ]


def _marked(slave: Any) -> Any:
    """A slave of FMPy whose functions leave their names, where the process is to."""
    for name in dir(slave):
        if name.startswith(("fmi2", "fmi3")):
            function = getattr(slave.dll, name)
            # Those with a status are called as FMPy does, without its two frames of Python in between.
            call = _checked(name, function) if function.restype is ctypes.c_int else getattr(slave, name)
            setattr(slave, name, marked(name, call))
    return slave


def _checked(name: str, function: Callable[..., int]) -> Callable[..., int]:
    """A function of an FMU that raises `FMICallException` where its status is no warning."""

    def call(*arguments: Any) -> int:
        status = function(*arguments)
        if status > _WARNING:
            raise FMICallException(function=name, status=status)
        return status

    return call


def _truth(value: Any) -> bool:
    """Of a value, or of a start value in a description."""
    return value.strip().lower() in ("true", "1") if isinstance(value, str) else bool(value)


def _span(places: NDArray[np.int64]) -> slice | NDArray[np.int64]:
    """Places that follow each other as a slice, which is quicker."""
    run = bool((np.diff(places) == 1).all())
    return slice(int(places[0]), int(places[-1]) + 1) if run else places


def _by_type(places: Sequence[Place]) -> dict[str, list[int]]:
    kinds: dict[str, list[int]] = {}
    for k, place in enumerate(places):
        kinds.setdefault(place.type, []).append(k)
    return kinds
