"""How a run of a study is repeated as a drive, or seen in the viewer."""

from __future__ import annotations

import os
import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ali3.files import make_folder, write_text
from ali3.running import command_name
from hosts.errors import HostError
from hosts.numbers import Value
from hosts.study.folder import read_record

FOLDER = "repeat"


@dataclass(frozen=True)
class Repeat:
    """Lines for a shell.

    Parameters
    ----------
    drive : str
        Makes the run again and writes its table, or does the test again.
    view : str
        Shows it moving; empty for a test.
    """

    drive: str
    view: str


def repeat_command(folder: str | os.PathLike[str], index: int, write: bool = True) -> Repeat:
    """The commands that repeat a run.

    Parameters
    ----------
    folder : path
        Of the study.
    index : int
        Of the run.
    write : bool
        Whether the manoeuvre they name is written, into the folder ``repeat``.

    Raises
    ------
    HostError
        There is no such run.
    """
    from hosts.study.plan import make_plan
    from hosts.study.study_file import read_study_file

    place = Path(folder)
    record = read_record(place)
    if record is None:
        raise HostError(f"{folder} is no folder of a study: there is no study.json in it.")
    if not 0 <= index < record["runs"]:
        raise HostError(f"There is no run {index}; the study in {folder} has the runs 0 to {record['runs'] - 1}.")
    study, _ = read_study_file(place / "study.toml")
    plan = make_plan(study, Path(record["file"]), place / record["fmu"])
    point, number = divmod(index, len(plan.work.jobs))
    job = plan.work.jobs[number]
    values = {name: column[0] for name, column in plan.points.block(point, 1).items()}
    fmu = str(place / record["fmu"])
    aliases = ["--aliases", str(plan.file.parent / study.aliases)] if study.aliases else []
    if job.manoeuvre is None:
        step = [] if study.step is None else ["--step", repr(study.step)]
        settings = [part for n, x in job.settings.items() for part in ("--test-setting", f"{job.test}.{n}={x!r}")]
        out = ["--out", str(place / FOLDER / f"run-{index}")]
        words = [fmu, "--tests", job.test, *_sets({**job.start, **values}), *settings, *step, *aliases, *out]
        return Repeat(_line("catalogue", words), "")
    file = place / FOLDER / f"run-{index}.csv"
    if write:
        _write_manoeuvre(job.manoeuvre, file)
    name = file.with_suffix(".ini") if not job.manoeuvre.inputs else file
    words = [fmu, "-m", str(name), "--step", repr(job.step), *_sets(values)]
    drive = _line("drive", [*words, "--out", str(place / FOLDER)])
    return Repeat(drive, _line("view", [*words, "--out", str(file.with_suffix(".html"))]))


def _sets(values: Mapping[str, Value]) -> list[str]:
    return [part for name, value in values.items() for part in ("--set", f"{name}={_text(value)}")]


def _text(value: Value) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value) if isinstance(value, str) else repr(value)


def _line(command: str, words: list[str]) -> str:
    return f"{command_name(command)} {shlex.join(words)}"


def _write_manoeuvre(manoeuvre: Any, file: Path) -> None:
    """A manoeuvre with all its start values, as the command drive reads it."""
    make_folder(file.parent)
    sections = {
        "run": {"stop_time": repr(manoeuvre.stop_time)},
        "start": {name: f'"{x}"' if isinstance(x, str) else _text(x) for name, x in manoeuvre.start.items()},
        "driver": manoeuvre.driver,
    }
    text = "\n".join(
        f"[{name}]\n" + "".join(f"{key} = {value}\n" for key, value in section.items())
        for name, section in sections.items()
        if section
    )
    write_text(file.with_suffix(".ini"), text)
    if not manoeuvre.inputs:
        return
    lines = [",".join(f'"{name}"' for name in ("time", *manoeuvre.inputs))]
    columns = [manoeuvre.time.tolist(), *(values.tolist() for values in manoeuvre.inputs.values())]
    lines += [",".join(map(repr, row)) for row in zip(*columns, strict=True)]
    if manoeuvre.state is not None:
        state = file.with_suffix(".state")
        state.write_bytes(manoeuvre.state)
        lines.insert(0, f"# state: {state.name} at {manoeuvre.state_time!r}")
    write_text(file, "\n".join(lines) + "\n")
