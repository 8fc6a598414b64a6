"""Collects events of the process of the car, and passes its rows to a recording."""

import json
import threading
from collections import deque
from collections.abc import Callable
from typing import Any, Protocol

from numpy.typing import ArrayLike

from ali3.errors import UserError
from hosts.simulator.car_events import Event
from hosts.simulator.shared_values import LOST_MESSAGES, LOST_ROWS, RECORDING, ROW, STATE_HEAD, SharedValues

_PERIOD = 0.03
_MAX_EVENTS = 10_000  # until the next call of `events`
RECORDING_CUT = "recording"
"""Kind of the event of an incomplete recording."""
_REMEDY = "What was written so far can be opened; make room, or record into another folder."


class Records(Protocol):
    """The interface of `hosts.recordings.recording.Recorder` that is used here."""

    told: list[str]

    def row(self, count: int, time: float, epoch: int, values: ArrayLike) -> None: ...
    def event(self, time: float, kind: str, text: str, *, epoch: int, **details: Any) -> None: ...
    def state(self, content: bytes, count: int | None = None, epoch: int = 0) -> None: ...
    def close(self, progress: Callable[[float], object] = ...) -> None: ...


class ProcessMessages:
    """Collects events, and passes rows and events to a recording in a thread."""

    def __init__(self, shared: SharedValues, recorder: Records | None) -> None:
        self._shared, self._recorder = shared, recorder
        self._lock, self._end = threading.Lock(), threading.Event()
        self._events: deque[Event] = deque(maxlen=_MAX_EVENTS)
        self._events_to_record: list[dict[str, Any]] = []
        self._lost = {LOST_ROWS: 0, LOST_MESSAGES: 0}
        self._thread: threading.Thread | None = None
        if recorder is not None:
            self._add_events(*recorder.told)
            self._thread = threading.Thread(target=self._write_until_end, name="recording", daemon=True)
            self._thread.start()

    def events(self) -> list[Event]:
        """Events since the last call."""
        with self._lock:
            if not self._end.is_set():
                self._collect()
            events = list(self._events)
            self._events.clear()
        return events

    def close(self, progress: Callable[[float], object]) -> None:
        """Collect the remaining messages after the end of the process, and finish the recording.

        `progress`: called with the finished fraction of its table.
        """
        with self._lock:
            self._collect()
            self._end.set()
        if self._thread is not None and self._recorder is not None:
            self._thread.join()
            complete = self._write_once()
            try:
                self._recorder.close(progress)
            except (OSError, UserError) as error:
                if complete:
                    self._add_events(f"The recording could not be finished: {error} {_REMEDY}", kind=RECORDING_CUT)

    def _add_events(self, *texts: str, kind: str = "told", time: float = 0.0) -> None:
        self._events.extend(Event(time, kind, text) for text in texts)

    def _collect(self) -> None:
        for message in self._shared.messages.take():
            record = json.loads(message)
            self._events.append(Event(record["time"], record["kind"], record["text"]))
            if self._recorder is not None:
                self._events_to_record.append(record)
        for flag, subject in ((LOST_ROWS, "rows of the recording"), (LOST_MESSAGES, "messages")):
            lost = int(self._shared.flags[flag])
            if lost > self._lost[flag]:
                self._lost[flag] = lost
                text = f"{lost} {subject} were lost so far: the computer did not take them in time."
                self._add_events(text, kind="overflow", time=float(self._shared.moments.read()[1]))

    def _write_until_end(self) -> None:
        while not self._end.wait(_PERIOD) and self._write_once():
            pass

    def _write_once(self) -> bool:
        """Write rows, states and events; False if there is no recording or an error has ended it."""
        recorder, shared = self._recorder, self._shared
        if recorder is None or not shared.flags[RECORDING]:
            return False
        with self._lock:
            if not self._end.is_set():
                self._collect()
            records, self._events_to_record = self._events_to_record, []
        head = len(ROW)
        try:
            for row in shared.rows.take():
                recorder.row(int(row[0]), float(row[1]), int(row[2]), row[head:])
            for message in shared.states.take():
                recorder.state(message[STATE_HEAD.size :], *STATE_HEAD.unpack_from(message))
            for r in records:
                recorder.event(r["time"], r["kind"], r["text"], epoch=r["epoch"], **r["details"])
        except (OSError, UserError) as error:
            shared.flags[RECORDING] = 0
            with self._lock:
                self._add_events(f"The recording ends here: {error} {_REMEDY}", kind=RECORDING_CUT)
            return False
        return True
