"""Messages while the simulator runs, and the report at its end."""

from __future__ import annotations

import time
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ali3.files import write_json
from hosts.simulator.notices import NOT_FINITE
from hosts.simulator.process_messages import RECORDING_CUT

if TYPE_CHECKING:
    from hosts.simulator.preparation import Prepared
    from hosts.simulator.step_times import StepTimes

_MAX_EVENTS = 1000


class RunReport:
    """Messages for the terminal, and figures of the run for a file.

    `begin`: when the command was started, by `time.monotonic`.
    """

    def __init__(self, begin: float) -> None:
        self._begin = begin
        self._figures: dict[str, Any] = {}
        self._marks: dict[str, float] = {}
        self._events: list[dict[str, str]] = []
        self._kinds: Counter[str] = Counter()

    @property
    def is_complete(self) -> bool:
        """Whether all values were finite and the recording, if any, is complete."""
        return not (self._kinds[RECORDING_CUT] or self._kinds["overflow"] or self._kinds[NOT_FINITE])

    def show(self, text: str) -> None:
        """Show a sentence on the terminal."""
        print(text, flush=True)

    def add_event(self, kind: str, text: str) -> None:
        """Show and store an event of the car."""
        self._kinds[kind] += 1
        if len(self._events) < _MAX_EVENTS:
            self._events.append({"kind": kind, "text": text})
        self.show(text)

    def mark(self, stage: str) -> float:
        """Store the time at which a stage is done; this time since the start of the command, s."""
        self._marks[stage] = time.monotonic() - self._begin
        return self._marks[stage]

    def show_prepared(self, prepared: Prepared, step: float) -> None:
        """Store and show what is driven."""
        self.mark("prepared")
        self._figures |= {
            "fmu": str(prepared.fmu.path),
            "model": prepared.description.modelName,
            "guid": prepared.description.guid,
            "world": prepared.world.name,
            "step": step,
            "settings": prepared.settings.records(),
            "built": prepared.fmu.built,
        }
        for name, text in prepared.settings.rows():
            self.show(f"{name}: {text}")
        self.show(f"Inputs are held over each step of {1e3 * step:g} ms: they act {500.0 * step:g} ms late on average.")

    def show_ready(self) -> None:
        """Show the time until the server or the headless run was ready."""
        seconds, built = self.mark("ready"), self._figures["built"]
        build_text = f"cold: the FMU was built in {built:.1f} s of it" if built else "warm: the FMU was there"
        self.show(f"Ready {seconds:.2f} s after the start of the command ({build_text}).")

    def show_first_frame(self) -> None:
        """Show the time of the first frame of the first page."""
        self.show(f"First frame sent to a page {self.mark('first frame'):.2f} s after the start of the command.")

    def finish(self, times: StepTimes, file: Path | None) -> None:
        """Show the report, and write it. `file`: JSON. Raises `FileError` if it cannot be written."""
        self.show(times.text())
        if self._kinds:
            counts = ", ".join(f"{kind} {count}" for kind, count in sorted(self._kinds.items()))
            self.show(f"messages: {counts}")
        if file is not None:
            self._figures |= {"seconds since the start": self._marks, "steps": times.report()}
            self._figures |= {"events": self._events, "event counts": dict(self._kinds)}
            write_json(file, self._figures)
            self.show(f"report: {file}")
