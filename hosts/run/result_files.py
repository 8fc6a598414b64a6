"""The files of a run: a table, a picture, and a record of what was run, in a folder."""

import csv
import json
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from ali3.columns import in_columns
from ali3.files import atomic_file, check_writable, write_text
from hosts.common.options import ROAD
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.pilots.course_follower import CourseFollower
from hosts.driving.result import Result
from hosts.driving.run_record import write_state
from hosts.driving.simulated_fmu import SimulatedFmu
from hosts.fmu.settings import Settings


def result_paths(out: Path, stem: str) -> tuple[Path, Path, Path]:
    """Table, picture and record of a run. `stem`: name of the files without suffix.

    Raises `FileError` before the run if they cannot be written.
    """
    table, picture, record = (out / f"{stem}{suffix}" for suffix in (".csv", ".png", ".json"))
    for file in (table, picture, record):
        check_writable(file)
    return table, picture, record


def write_csv(result: Result, file: Path) -> None:
    """Time, inputs and outputs as a table in FMPy's format. `file`: its folder is made if it is not there."""
    with atomic_file(file) as temporary, temporary.open("w", newline="", encoding="utf-8") as stream:
        csv.writer(stream, quoting=csv.QUOTE_NONNUMERIC).writerow(["time", *result.names])
        for t, row in zip(result.time.tolist(), result.values.tolist(), strict=True):
            stream.write(",".join(map(repr, (t, *row))) + "\r\n")  # as the writer does, in two thirds of its time


def write_record(
    fmu: SimulatedFmu,
    manoeuvre: Manoeuvre,
    step: float,
    settings: Settings,
    result: Result,
    file: Path,
    driver: CourseFollower | None = None,
    names: Mapping[str, tuple[str, float, float]] | None = None,
) -> None:
    """Write the record of a run and of the settings of its FMU as JSON.

    Parameters
    ----------
    manoeuvre : Manoeuvre
        A state that it begins with is written beside the record.
    step : float
        Communication step, s.
    file : Path
        Its folder is made if it is not there.
    driver : CourseFollower, optional
        Driver of the run; the view draws the cones of its course.
    names : mapping of str to (str, float, float), optional
        By the FMU's names those of the table, with factor and offset: value of the FMU = factor * that + offset.
    """
    state, road = None, Path(str(settings.start.get(ROAD, "")))
    if manoeuvre.state is not None:
        state = {"file": write_state(manoeuvre.state, file).name, "time": manoeuvre.state_time}
    record = {
        "fmu": str(fmu.path),
        "model": fmu.description.modelName,
        "token": fmu.description.guid,
        "manoeuvre": manoeuvre.name,
        "step_s": step,
        "interval_s": float(result.time[1]) if len(result.time) > 1 else step,
        "lost": result.lost,
        "simulated_s": result.simulated,
        "failed_steps": result.failed_steps,
        "set": settings.records(),
        "start": dict(manoeuvre.start),
        "held": result.held,
        "jumps": {k: [float(result.time[k]), *before] for k, before in result.jumps.items()},
        "state": state,
        "course": driver and {"track": driver.course.name, "vehicle_width": driver.settings.vehicle_width},
        "marks": result.marks,
        "world": road.stem if road.suffix and road.with_suffix(".json").is_file() else None,
        "outputs_from": next(iter(fmu.names("output")), ""),
        **({"names": names} if names else {}),
    }
    write_text(file, json.dumps(record, indent=2, ensure_ascii=False) + "\n")


def print_result(tables: Iterable[Sequence[tuple[str, str]]], result: Result, files: Sequence[Path]) -> int:
    """Print tables, remarks on the run and the paths of the files. Result: exit code, 0 if every step is good."""
    for line in (*(line for rows in tables for line in in_columns(rows)), *result.remarks()):
        print(line)
    print(f"written: {', '.join(map(str, files))}")
    return 0 if result.is_good else 1
