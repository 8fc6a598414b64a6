"""An FMU's WebAssembly module in wasmtime, with the methods of FMPy's slave, without the page's JavaScript."""

import struct
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any

import wasmtime
from fmpy.fmi1 import FMICallException

_FORMATS = {"Real": "d", "Integer": "i", "String": "I"}
_ENGINE = wasmtime.Engine()


@lru_cache(maxsize=4)
def _compiled(wasm: bytes) -> wasmtime.Module:
    return wasmtime.Module(_ENGINE, wasm)


class FmuModule:
    """A module with its resource files, and one instance of the FMU.

    `wasm`: content of ``binaries/wasm32/NAME.wasm``; `resources`: contents by path in the folder ``resources``;
    `memory_limit`: largest memory of the module, bytes.
    """

    def __init__(self, wasm: bytes, resources: Mapping[str, bytes], guid: str, memory_limit: int | None = None) -> None:
        module = _compiled(wasm)
        self._store = wasmtime.Store(_ENGINE)
        if memory_limit is not None:
            self._store.set_limits(memory_size=memory_limit)
        exports: Any = wasmtime.Instance(self._store, module, []).exports(self._store)
        self._exports, self._memory = exports, exports["memory"]
        self._call("_initialize")
        self.messages: list[tuple[int, str]] = []
        for path, data in resources.items():
            self.add_file(path, data)
        self._pointer_address = self._call("malloc", 16)
        self._component = self._call(
            *("fmi2Instantiate", self.text("wasmtime"), 1, self.text(guid), self.text("file:///resources")),
            *(self._call("ali3_callbacks"), 0, 0),
        )
        self.fetch_messages()

    @property
    def there(self) -> bool:
        """Whether the FMU gave an instance."""
        return bool(self._component != 0)

    def _call(self, name: str, *arguments: Any) -> Any:
        return self._exports[name](self._store, *arguments)

    def fetch_messages(self) -> None:
        """Append the messages since the last call to `messages`, as status and text."""
        buffer = self._call("ali3_messages")
        used, lost = struct.unpack("<2I", self.bytes_at(buffer, 8))
        words = bytes(self.bytes_at(buffer + 8, used)).decode().split("\0")[:-1]
        self.messages += [(int(head[0]), text) for head, text in zip(words[::2], words[1::2], strict=True)]
        self.messages += [(1, f"{lost} lost")] if lost else []
        self._memory.write(self._store, bytes(8), buffer)

    @property
    def memory_size(self) -> int:
        """Bytes of the module's memory."""
        return int(self._memory.data_len(self._store))

    def address(self, name: str) -> int:
        """Return value of an exported function without arguments."""
        return int(self._call(name))

    def add_file(self, path: str, data: bytes) -> None:
        """Add a file to the resources; raises MemoryError."""
        block = self.block(data)
        if block == 0 or not self._call("ali3_file_add", self.text(f"/resources/{path}"), block, len(data)):
            raise MemoryError(path)

    def remove_file(self, path: str) -> bool:
        """Remove a file from the resources; returns whether it existed."""
        return bool(self._call("ali3_file_remove", self.text(f"/resources/{path}")))

    def bytes_at(self, address: int, size: int) -> bytes:
        """Bytes of the module's memory."""
        return bytes(self._memory.read(self._store, address, address + size))

    def block(self, data: bytes) -> int:
        """Allocate a copy of these bytes, which is not freed; its address, 0 without memory."""
        address = int(self._call("malloc", max(len(data), 1)))
        if address != 0:
            self._memory.write(self._store, data, address)
        return address

    def text(self, text: str) -> int:
        """Allocate a copy of a text, which is not freed; its address."""
        return self.block(text.encode() + b"\0")

    def fmi(self, name: str, *arguments: Any) -> None:
        """Call a function of FMI for the instance; raises FMICallException."""
        status = self._call(name, self._component, *arguments)
        self.fetch_messages()
        if status > 1:
            raise FMICallException(function=name, status=status)

    def caller(self, name: str) -> Callable[..., int]:
        """A function of FMI for the instance, without messages and exceptions: for time measurements."""
        function, store, component = self._exports[name], self._store, self._component
        return lambda *arguments: int(function(store, component, *arguments))

    def setupExperiment(self, startTime: float = 0.0, stopTime: float | None = None) -> None:
        self.fmi("fmi2SetupExperiment", 0, 0.0, startTime, int(stopTime is not None), stopTime or 0.0)

    def enterInitializationMode(self) -> None:
        self.fmi("fmi2EnterInitializationMode")

    def exitInitializationMode(self) -> None:
        self.fmi("fmi2ExitInitializationMode")

    def doStep(self, time: float, step: float) -> None:
        self.fmi("fmi2DoStep", time, step, 1)

    def reset(self) -> None:
        self.fmi("fmi2Reset")

    def get(self, kind: str, references: Sequence[int]) -> list[Any]:
        """Values of variables of a type."""
        form, n = _FORMATS[kind], len(references)
        result, where = self.block(bytes(8 * n)), self.block(struct.pack(f"<{n}I", *references))
        self.fmi(f"fmi2Get{kind}", where, n, result)
        values = list(struct.unpack(f"<{n}{form}", self.bytes_at(result, n * struct.calcsize(form))))
        for block in (result, where):
            self._call("free", block)
        return values

    def set(self, kind: str, references: Sequence[int], values: Sequence[Any]) -> None:
        """Set variables of a type."""
        n = len(references)
        encoded = [self.text(v) for v in values] if kind == "String" else values
        data, where = (
            self.block(struct.pack(f"<{n}{_FORMATS[kind]}", *encoded)),
            self.block(struct.pack(f"<{n}I", *references)),
        )
        self.fmi(f"fmi2Set{kind}", where, n, data)
        for block in (data, where):
            self._call("free", block)

    def getReal(self, references: Sequence[int]) -> list[float]:
        return self.get("Real", references)

    def getInteger(self, references: Sequence[int]) -> list[int]:
        return self.get("Integer", references)

    def setReal(self, references: Sequence[int], values: Sequence[float]) -> None:
        self.set("Real", references, values)

    def setInteger(self, references: Sequence[int], values: Sequence[int]) -> None:
        self.set("Integer", references, values)

    def setString(self, references: Sequence[int], values: Sequence[str]) -> None:
        self.set("String", references, values)

    def _pointer(self, name: str, *arguments: Any, value: int = 0) -> int:
        self._memory.write(self._store, struct.pack("<I", value), self._pointer_address)
        self.fmi(name, *arguments, self._pointer_address)
        return int(struct.unpack("<I", self.bytes_at(self._pointer_address, 4))[0])

    def getFMUState(self) -> int:
        return self._pointer("fmi2GetFMUstate")

    def setFMUState(self, state: int) -> None:
        self.fmi("fmi2SetFMUstate", state)

    def freeFMUState(self, state: int) -> None:
        self._pointer("fmi2FreeFMUstate", value=state)

    def serializeFMUState(self, state: int) -> bytes:
        size = self._pointer("fmi2SerializedFMUstateSize", state)
        block = self.block(bytes(size))
        self.fmi("fmi2SerializeFMUstate", state, block, size)
        data = self.bytes_at(block, size)
        self._call("free", block)
        return data

    def deserializeFMUState(self, data: bytes) -> int:
        block = self.block(data)
        try:
            return self._pointer("fmi2DeSerializeFMUstate", block, len(data))
        finally:
            self._call("free", block)
