"""The record beside a result: its FMU, names of columns, and what was drawn on the ground."""

from pathlib import Path
from typing import Any

from ali3.json_reading import read_json
from ali3.reading import is_file
from hosts.common.errors import HostError
from hosts.driving.course import TRACKS, course_of
from hosts.driving.course_scenery import with_course, with_marks
from hosts.view.result_tables import Table

MARKS_OF_MANOEUVRE = "marks of the manoeuvre on the ground"
"""Name of the marks where they are missing in a scene."""
_LARGEST_WIDTH = 10.0  # m, of a vehicle


def read_record(file: Path) -> dict[str, Any] | None:
    """The record beside a result; None where it is another JSON file."""
    record = read_json(file, HostError, f"{file}, the record of the result,", finite=False)
    if not isinstance(record, dict) or not isinstance(record.get("fmu"), str):
        return None
    entries = record.get("set", [])
    if not isinstance(entries, list) or not all(isinstance(e, dict) and {"name", "new"} <= set(e) for e in entries):
        raise HostError(f"{file}, the record of the result, does not say by 'set' what was set in the FMU.")
    return record | {"set": entries}


def add_names_of_fmu(table: Table, units: dict[str, str], record: dict[str, Any], file: Path) -> None:
    """Add columns under the names of the FMU, which its drawing reads, to a table under our names."""
    names = record.get("names", {})
    try:
        converted = {str(theirs): (str(ours), float(f), float(o)) for theirs, (ours, f, o) in names.items()}
    except (AttributeError, TypeError, ValueError):
        raise HostError(
            f"{file}, the record of the result, does not say by 'names' a name, a factor and an offset for each of the "
            "FMU's names."
        ) from None
    for theirs, (ours, factor, offset) in converted.items():
        if ours in table.columns and theirs not in table.columns:
            table.columns[theirs] = factor * table.columns[ours] + offset
            if (factor, offset) == (1.0, 0.0):
                units.setdefault(ours, units.get(theirs, ""))


def with_recorded_course(scene: dict[str, Any], record: dict[str, Any], file: Path) -> dict[str, Any]:
    """The scene with the cones of the course, if the record names one."""
    course = record.get("course")
    if course is None:
        return scene
    track, width = (course.get(key) if isinstance(course, dict) else None for key in ("track", "vehicle_width"))
    name = next((name for name, gates in TRACKS.items() if gates == track), None)
    if name is None or not isinstance(width, (int, float)) or not 0.0 < width < _LARGEST_WIDTH:
        raise HostError(
            f"{file}, the record of the result, does not say by 'course' a track of ISO 3888 and a vehicle_width, m."
        )
    return with_course(scene, course_of(name, float(width)))


def with_recorded_marks(scene: dict[str, Any], record: dict[str, Any], file: Path) -> dict[str, Any]:
    """The scene with the ground marks of the manoeuvre, if the record has some."""
    try:
        return with_marks(scene, record.get("marks") or [], MARKS_OF_MANOEUVRE)
    except (KeyError, TypeError, ValueError, OverflowError):
        raise HostError(
            f"{file}, the record of the result, does not say by 'marks' lanes, lines and circles with their places, m."
        ) from None


def fmu_of_record(record: dict[str, Any], file: Path) -> Path:
    """The FMU of a record: its path is relative to this folder, to that of the record or to one above."""
    fmu_path = Path(record["fmu"])
    record_folder = file.absolute().parent
    candidates = (
        [fmu_path, *(folder / fmu_path for folder in (record_folder, *record_folder.parents))]
        if not fmu_path.is_absolute()
        else [fmu_path]
    )
    candidates.append(record_folder / fmu_path.name)
    result = next((path for path in candidates if is_file(path)), None)
    if result is None:
        raise HostError(
            f"{file} names the FMU {fmu_path}, which is not there any more; say where it is now by --geometry FMU."
        )
    return result
