"""Memory shared by the process of the car and the main process, without locks."""

import threading
from dataclasses import dataclass
from multiprocessing.shared_memory import SharedMemory
from pathlib import Path
from struct import Struct

import numpy as np
from numpy.typing import NDArray

from ali3.child_processes import stop_signals_blocked
from hosts.simulator.step_times import TIMES_SIZE

MOMENT = (
    *("count", "time", "epoch", "running", "refused", "behind", "speed", "wall"),
    *("cost", "worst", "lateness", "missed", "saved"),
)
"""Number of values of a state before the columns."""
ROW = ("count", "time", "epoch")
"""Number of values of a row of a recording before the columns."""
STATE_HEAD = Struct("<qq")
"""Count and epoch of the row after which a state was saved."""
STOP, RECORDING, LOST_ROWS, LOST_MESSAGES = range(4)
"""Indices of flags: the process of the car has to end; rows are recorded; rows and messages without room."""
_FLAGS = 8
_COMMANDS = 256
_MESSAGE_BYTES = 1 << 18
_STATE_BYTES = 1 << 20
_READ_ATTEMPTS = 4
_BARRIER_LOCK = threading.Lock()


def _memory_barrier() -> None:
    """A memory barrier: other processes see earlier writes before later ones."""
    with _BARRIER_LOCK:
        pass


def shared_files(name: str) -> list[Path]:
    """Files of the shared memory of a name."""
    file = Path("/dev/shm", name)
    return [file] if file.exists() else []


class TwoSlots:
    """A record with one writer and any number of readers, written alternately into two slots.

    A reader copies the slot that was finished last. The copy is inconsistent only if the writer has begun two records
    meanwhile; after some such attempts the reader keeps its former record.

    `counters`: int64, initially zero: numbers of the last record begun and of the last finished, shape (2,);
    `slots`: shape (2, n).
    """

    def __init__(self, counters: NDArray[np.int64], slots: NDArray[np.float64]) -> None:
        self._counters, self._slots = counters, slots
        self._last: NDArray[np.float64] = slots[0].copy()

    @property
    def written(self) -> int:
        """Number of records finished so far."""
        return int(self._counters[1])

    def begin(self) -> NDArray[np.float64]:
        """The slot of the next record; `finish` publishes it."""
        number = int(self._counters[0]) + 1
        self._counters[0] = number
        _memory_barrier()
        slot: NDArray[np.float64] = self._slots[number % 2]
        return slot

    def finish(self) -> None:
        _memory_barrier()
        self._counters[1] = self._counters[0]

    def read(self) -> NDArray[np.float64]:
        """A copy of the last record, or of an older one if the writer was too fast."""
        for _ in range(_READ_ATTEMPTS):
            number = int(self._counters[1])
            _memory_barrier()
            copy: NDArray[np.float64] = self._slots[number % 2].copy()
            _memory_barrier()
            if self._counters[0] <= number + 1:
                self._last = copy
                break
        return self._last


class Ring:
    """A ring buffer of rows with one writer and one reader.

    `counters`: int64, initially zero: rows written and read, shape (2,); `rows`: shape (capacity, n).
    """

    def __init__(self, counters: NDArray[np.int64], rows: NDArray[np.float64]) -> None:
        self._counters, self._rows = counters, rows
        self._capacity = len(rows)

    def has_room(self) -> bool:
        return int(self._counters[0] - self._counters[1]) < self._capacity

    def slot(self) -> NDArray[np.float64]:
        """The row to write if there is room; `finish` publishes it."""
        row: NDArray[np.float64] = self._rows[int(self._counters[0]) % self._capacity]
        return row

    def finish(self) -> None:
        _memory_barrier()
        self._counters[0] += 1

    def take(self) -> NDArray[np.float64]:
        """Remove and return all waiting rows, shape (k, n)."""
        written = int(self._counters[0])
        read = max(int(self._counters[1]), written - self._capacity)  # a faulty FMU may have overwritten both
        _memory_barrier()
        rows: NDArray[np.float64] = self._rows[np.arange(read, written) % self._capacity]
        _memory_barrier()
        self._counters[1] = written
        return rows


class ByteRing:
    """A ring buffer of messages of any length with one writer and one reader.

    `counters`: int64, initially zero: bytes written and read, shape (2,); `data`: uint8, shape (n,).
    """

    _HEAD = 4

    def __init__(self, counters: NDArray[np.int64], data: NDArray[np.uint8]) -> None:
        self._counters, self._data = counters, data

    def put(self, message: bytes) -> bool:
        """Append a message; returns whether there was room."""
        written, size = int(self._counters[0]), len(self._data)
        record = np.frombuffer(len(message).to_bytes(self._HEAD, "little") + message, np.uint8)
        if written - int(self._counters[1]) + len(record) > size:
            return False
        begin = written % size
        first = min(len(record), size - begin)
        self._data[begin : begin + first] = record[:first]
        self._data[: len(record) - first] = record[first:]
        _memory_barrier()
        self._counters[0] = written + len(record)
        return True

    def take(self) -> list[bytes]:
        """Remove and return all waiting messages."""
        written = int(self._counters[0])
        read = max(int(self._counters[1]), written - len(self._data))
        _memory_barrier()
        data = self._data[np.arange(read, written) % len(self._data)].tobytes()
        _memory_barrier()
        self._counters[1] = written
        messages, offset = [], 0
        while offset < len(data):
            begin = offset + self._HEAD
            offset = begin + int.from_bytes(data[offset:begin], "little")
            messages.append(data[begin:offset])
        return messages


@dataclass(frozen=True)
class Sizes:
    """Sizes that determine the layout of the shared memory."""

    inputs: int
    """Number of inputs."""
    columns: int
    """Number of inputs and outputs."""
    rows: int
    """Largest number of waiting rows of a recording."""


class SharedValues:
    """Views of the shared memory.

    `name`: name of memory that another process has created; None: it is created.

    Attributes
    ----------
    flags : ndarray of shape (8,)
        int64, indexed by `STOP` and others.
    moments : TwoSlots
        From the car: `MOMENT`, then the columns.
    wants : TwoSlots
        To the car, for each input: value, largest change per second, number of the request.
    commands : Ring
        To the car: number of the command, value, number of the last request before it.
    rows : Ring
        From the car: `ROW`, then the columns.
    messages, states : ByteRing
        From the car; states of a recording begin with `STATE_HEAD`.
    times : ndarray
        From the car, see `hosts.simulator.step_times`.
    """

    def __init__(self, sizes: Sizes, name: str | None = None) -> None:
        moment, wants, row = len(MOMENT) + sizes.columns, 3 * sizes.inputs, len(ROW) + sizes.columns
        counters = 12
        doubles = 2 * moment + 2 * wants + 3 * _COMMANDS + row * sizes.rows + TIMES_SIZE
        size = 8 * (_FLAGS + counters + doubles) + _MESSAGE_BYTES + _STATE_BYTES
        with stop_signals_blocked():  # Python starts a helper process for shared memory
            self._memory = SharedMemory(name) if name else SharedMemory(create=True, size=size)
        self.name = self._memory.name
        assert self._memory.buf is not None
        self._unused, self._owner = self._memory.buf, name is None
        self.flags = np.frombuffer(self._take(8 * _FLAGS), np.int64)
        pairs = np.frombuffer(self._take(8 * counters), np.int64).reshape(6, 2)
        self.moments = TwoSlots(pairs[0], self._doubles(2, moment))
        self.wants = TwoSlots(pairs[1], self._doubles(2, wants))
        self.commands = Ring(pairs[2], self._doubles(_COMMANDS, 3))
        self.rows = Ring(pairs[3], self._doubles(sizes.rows, row))
        self.times = self._doubles(1, TIMES_SIZE)[0]
        self.messages = ByteRing(pairs[4], np.frombuffer(self._take(_MESSAGE_BYTES), np.uint8))
        self.states = ByteRing(pairs[5], np.frombuffer(self._take(_STATE_BYTES), np.uint8))
        del self._unused

    def _doubles(self, rows: int, columns: int) -> NDArray[np.float64]:
        return np.frombuffer(self._take(8 * rows * columns), np.float64).reshape(rows, columns)

    def _take(self, size: int) -> memoryview:
        view, self._unused = self._unused[:size], self._unused[size:]
        return view

    def close(self) -> None:
        """Release the memory; the views must not be used any more."""
        del self.flags, self.moments, self.wants, self.commands, self.rows, self.times, self.messages, self.states
        try:
            self._memory.close()
        finally:
            if self._owner:
                self._memory.unlink()
