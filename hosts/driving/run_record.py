"""The record beside a table that is the result of a run, and the saved state of the FMU beside a manoeuvre."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

from pydantic import BaseModel, Field, FiniteFloat, ValidationError

from ali3.files import write_bytes
from ali3.json_reading import read_json
from ali3.named_files import NamedFiles
from ali3.reading import LARGEST_STATE, is_file, read_bytes
from hosts.common.errors import HostError
from hosts.common.numbers import Value

Length = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
"""A length of time, s."""


@dataclass(frozen=True)
class RunRecord:
    """What a table alone does not say about the run that wrote it."""

    outputs_from: str = ""
    """Name of the first output; the columns before it are inputs."""
    start: Mapping[str, Value] = field(default_factory=dict)
    """Start values and parameters that were set."""
    held: set[str] | None = None
    """Inputs that were constant over each step; None: unknown."""
    jumps: Mapping[int, list[float]] = field(default_factory=dict)
    """By row: time, s, and inputs before a jump at that time."""
    state: tuple[bytes | None, float] = (None, 0.0)
    """Saved state of the FMU in which the run began, and its time, s."""
    step: float | None = None
    """Communication step, s."""
    interval: float = 0.0
    """Time between rows, s."""
    lost: tuple[str, ...] = ()
    """Inputs that are not linear between rows."""


class _State(BaseModel):
    """Entry of a saved state: name of its file, and time, s."""

    file: str
    time: float


class _RecordFile(BaseModel):
    """A record as it stands in its file; see `RunRecord`."""

    outputs_from: str
    start: dict[str, bool | int | float | str]
    held: list[str]
    jumps: dict[int, Annotated[list[FiniteFloat], Field(min_length=1)]]
    state: _State | None
    step_s: Length
    interval_s: Length | None = None
    lost: list[str] = []


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
        content = _RecordFile.model_validate(record)
    except ValidationError:
        raise HostError(f"{file} is not a whole record of the run whose result is {path.name}; run it again.") from None
    saved = content.state
    return RunRecord(
        content.outputs_from,
        content.start,
        set(content.held),
        content.jumps,
        (None, 0.0) if saved is None else (read_state(path.parent, saved.file, str(file)), saved.time),
        content.step_s,
        content.step_s if content.interval_s is None else content.interval_s,
        tuple(content.lost),
    )


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
