"""The record beside a table that is the result of a run, and the saved state of the FMU beside a manoeuvre."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ali3.files import write_bytes
from ali3.json_reading import read_json
from ali3.named_files import NamedFiles
from ali3.reading import LARGEST_STATE, is_file, read_bytes
from hosts.common.errors import HostError
from hosts.common.numbers import Value


@dataclass(frozen=True)
class RunRecord:
    """A record: first output, start values, held inputs, by row the time and inputs before a jump, initial state and
    its time, communication step and interval of rows, s, and inputs that are not linear between rows.
    """

    outputs_from: str = ""
    start: Mapping[str, Value] = field(default_factory=dict)
    held: set[str] | None = None
    jumps: Mapping[int, list[float]] = field(default_factory=dict)
    state: tuple[bytes | None, float] = (None, 0.0)
    step: float | None = None
    interval: float = 0.0
    lost: tuple[str, ...] = ()


def rows_before_jumps(
    record: RunRecord, path: Path, times: Sequence[float], inputs: int
) -> list[tuple[int, list[float]]]:
    """Rows before jumps that a table lacks, the last first: number of the following row, and inputs.

    Raises `HostError`: the record does not belong to the table.
    """
    results = []
    for k, (t, *before) in sorted(record.jumps.items(), reverse=True):
        if not 0 <= k < len(times) or times[k] != t or len(before) != inputs:
            raise HostError(
                f"{path} is not the table that {path.with_suffix('.json').name} beside it was written with: an input "
                f"jumps in row {k} at {t:g} s. Give the table another name, or its columns of inputs alone."
            )
        results.append((k, before))
    return results


def record_of(path: Path) -> RunRecord:
    """The record beside a table; an empty one if there is none."""
    file = path.with_suffix(".json")
    try:
        record = read_json(file, HostError, finite=False) if is_file(file) else None
    except HostError:
        return RunRecord()  # another JSON file, not a record
    if not isinstance(record, dict) or "outputs_from" not in record:
        return RunRecord()
    try:
        first, start, held, state, step = (record[key] for key in ("outputs_from", "start", "held", "state", "step_s"))
        jumps = {int(k): [float(x) for x in values] for k, values in record["jumps"].items()}
        interval, lost = float(record.get("interval_s", step)), record.get("lost", [])
        texts = [first, *held, *lost] if isinstance(held, list) and isinstance(lost, list) else [None]
        sizes = (float(step), interval, *(1.0 + abs(x) for values in jumps.values() for x in values))
        valid = all(isinstance(text, str) for text in texts) and all(0.0 < size < math.inf for size in sizes)
        if not valid or not all(jumps.values()):
            raise ValueError
        if any(not isinstance(value, (bool, int, float, str)) for value in start.values()):
            raise ValueError
        saved = (None, 0.0) if state is None else (read_state(path.parent, state["file"], str(file)), state["time"])
        state_and_time = saved[0], float(saved[1])
        return RunRecord(first, start, set(held), jumps, state_and_time, float(step), interval, tuple(lost))
    except (AttributeError, KeyError, TypeError, ValueError):
        raise HostError(f"{file} is not a whole record of the run whose result is {path.name}; run it again.") from None


def read_state(folder: Path, name: str, where: str) -> bytes:
    """Read the saved state of an FMU. `name`: below the folder; `where`: of the name, for messages.

    Raises `HostError`: the file is outside of the folder, or cannot be read.
    """
    file = NamedFiles(folder, LARGEST_STATE, HostError).file(name, folder, f"{where}: the state")
    return read_bytes(file, LARGEST_STATE, HostError, f"{where}: the state {file}")


def write_state(state: bytes, file: Path) -> Path:
    """Write a saved state beside a file; the path of the state."""
    beside = file.with_suffix(".state")
    write_bytes(beside, state)
    return beside
