"""Recordings for the view: from results of the hosts, tables of `mbs` runs, and FMUs, which are run first."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ali3.archives import is_archive
from ali3.processes import command_name
from ali3.reading import is_file, is_file_or_folder, is_folder, missing_file_text
from ali3.scene.recording import Recording
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.common.options import FmuOptions
from hosts.driving.course_scenery import with_course, with_marks
from hosts.driving.driver import driver_of
from hosts.driving.manoeuvre import with_names_of
from hosts.driving.manoeuvre_settings import apply_settings
from hosts.driving.pilots.pilot import ACTS, OBSERVED
from hosts.driving.run_checks import check_columns, communication_step
from hosts.driving.runs_with_progress import run_with_bar
from hosts.fmu.fmu import Fmu, described
from hosts.fmu.geometry import RESOURCE, scene_from, scene_of
from hosts.fmu.variables import Variables
from hosts.recordings.format import is_recording
from hosts.recordings.load_manoeuvre import manoeuvre_of
from hosts.recordings.recorded_view import other_build, recorded_view
from hosts.view.result_record import (
    MARKS_OF_MANOEUVRE,
    add_names_of_fmu,
    fmu_of_record,
    read_record,
    with_recorded_course,
    with_recorded_marks,
)
from hosts.view.result_tables import read_table

_CAR_MANOEUVRE = "double_lane_change"  # of a car if none is given


@dataclass(frozen=True)
class ViewRunOptions:
    """Options of the run of an FMU."""

    manoeuvre: str | None
    """As for the command run."""
    stop_time: float | None
    step: float | None
    """`stop_time`, `step`: s."""
    fmu_options: FmuOptions

    def __bool__(self) -> bool:
        return bool(self.fmu_options) or any(x is not None for x in (self.manoeuvre, self.stop_time, self.step))


def recordings_of(
    paths: Sequence[Path], geometry: Path | None, run: ViewRunOptions
) -> tuple[list[Recording], list[str], bool]:
    """Recordings of paths of the user.

    `geometry`: FMU or scene that results are drawn with, in place of that of their record. Raises `HostError` with one
    sentence: a path cannot be read or run.

    Returns
    -------
    recordings : list of Recording
        With names that differ.
    notes : list of str
        Sentences for the user.
    good : bool
        Whether every FMU that was run made all steps, and its outputs are finite.
    """
    results: list[Recording] = []
    notes: list[str] = []
    good = True
    for path, name in zip(paths, _distinct_names(paths), strict=True):
        if not is_file_or_folder(path):
            hint = f" Build it with: {command_name('build')}" if path.suffix == ".fmu" else ""
            raise HostError(missing_file_text(path, hint))
        suffix = path.suffix.lower()
        if is_recording(path):
            recording, message = recorded_view(path, name, geometry)
        elif suffix == ".fmu" or (suffix not in (".csv", ".json") and is_archive(path)):
            recording, message, is_good = _run_fmu(path, name, run)
            good = good and is_good
        elif suffix in (".csv", ".json"):
            recording, message = _read_result(path, name, geometry)
        else:
            raise HostError(_unknown_kind(path))
        results.append(recording)
        notes += message
    if run and not any(path.suffix.lower() == ".fmu" for path in paths):
        raise HostError("Manoeuvre, times and values are set for an FMU that is run; results are shown as they are.")
    _report_other_grounds(results)
    return results, notes, good


def _report_other_grounds(recordings: Sequence[Recording]) -> None:
    """Add a note to each run on another ground than that of the first one, which is drawn."""
    grounds = [(one, one.scene.get("roads", [])) for one in recordings if one.scene is not None]
    for ghost, ground in grounds[1:]:
        first, drawn_ground = grounds[0]
        if ground != drawn_ground:
            ghost.notes.append(f"It ran on another ground than {first.name}, whose ground is drawn.")


def _unknown_kind(path: Path) -> str:
    if is_folder(path):
        return f"{path} is a folder; name a result in it (a .csv file), an FMU, or the folder of a recording."
    if path.suffix.lower() == ".py":
        return f"{path} is shown when it is built: {command_name('build')} makes an FMU of a scene."
    return f"{path} is neither a result (.csv, .json) nor an FMU (.fmu)."


def _distinct_names(paths: Sequence[Path]) -> list[str]:
    """Names of files, with as much of their folders as makes them differ."""
    parts = [path.absolute().with_suffix("").parts for path in paths]
    names = [part[-1] for part in parts]
    for depth in range(2, max(map(len, parts)) + 1):
        if len(set(names)) == len(names):
            break
        names = ["/".join(part[-depth:]) for part in parts]
    return [name if names.index(name) == k else f"{name} ({k + 1})" for k, name in enumerate(names)]


def _read_result(path: Path, name: str, geometry: Path | None) -> tuple[Recording, list[str]]:
    """The recording of a table, with the scene of the FMU that its record names, and notes."""
    table_file, record_file = path.with_suffix(".csv"), path.with_suffix(".json")
    if not is_file(table_file):
        raise HostError(f"{path} has no table {table_file.name} beside it; name the .csv file of a result.")
    table = read_table(table_file)
    record = read_record(record_file) if is_file(record_file) else None
    units: dict[str, str] = dict(table.units)
    notes: list[str] = []
    source: Path | None = None
    scene: dict[str, Any] | None = None
    constants: dict[str, float] = {}
    settings = {entry["name"]: entry["new"] for entry in record["set"]} if record is not None else {}
    if record is not None:
        source = geometry or fmu_of_record(record, record_file)
        scene = scene_from(source, settings, record.get("world"))
        if is_archive(source):
            declared, constants, same = _declared(source, str(record.get("token", "")), settings)
            units = declared | units
            if not same:
                notes.append(other_build(source, name))
        add_names_of_fmu(table, units, record, record_file)
        if scene is not None:
            scene = with_recorded_marks(with_recorded_course(scene, record, record_file), record, record_file)
    elif geometry is not None or is_file(record_file):
        source = geometry or record_file  # a scene
        scene = scene_from(source)
        if scene is not None and scene.get("roads") and is_archive(source):
            notes.append(
                f"{table_file} has no record {record_file.name} beside it that says where it ran: what is drawn of the "
                f"ground is that of {source} as it was built."
            )
    else:
        notes.append(
            f"{table_file} has no record {record_file.name} beside it that names its FMU, and no scene of that name: "
            "its signals can be plotted, and nothing is drawn; --geometry FILE names an FMU or a scene."
        )
    if source is not None and scene is None:
        notes.append(_without_scene(source))
    recording = Recording(scene, table.t, table.columns, units, name)
    recording.constants = constants
    if scene is not None and recording.scene is not None and scene["shapes"] and not recording.scene["shapes"]:
        why = recording.missing[-1]["why"].rstrip(".") if recording.missing else "no shape has a pose"
        notes.append(f"{table_file} contains no poses that could be drawn ({why}); its signals can be plotted.")
    recording.notes += [table.note] if table.note else []
    return recording, notes


def _declared(fmu: Path, token: str, settings: Mapping[str, Value]) -> tuple[dict[str, str], dict[str, float], bool]:
    """Units of the variables of an FMU, its constants and parameters, and whether its token is that of the record."""
    description = described(fmu)
    units = {v.name: v.unit or "" for v in description.modelVariables}
    is_same = not token or str(description.guid or description.instantiationToken) == token
    return units, Variables(description).constants(settings), is_same


def _without_scene(path: Path) -> str:
    return (
        f"{path} has no {RESOURCE}, which says what there is to draw: its signals can be plotted, and nothing is "
        "drawn; FMUs that ali3 builds have it."
    )


def _run_fmu(path: Path, name: str, run_options: ViewRunOptions) -> tuple[Recording, list[str], bool]:
    """The recording of a run of an FMU, by a manoeuvre or its default experiment; notes; whether the run is good."""
    notes = []
    with Fmu(path) as fmu:
        manoeuvre_name = run_options.manoeuvre
        car = set(ACTS) <= set(fmu.names("input")) and set(OBSERVED) <= set(fmu.names("output"))
        if manoeuvre_name is None and car and run_options.stop_time is None:
            manoeuvre_name = _CAR_MANOEUVRE
            notes.append(f"{path} is driven through {manoeuvre_name}; --manoeuvre names another.")
        manoeuvre = with_names_of(manoeuvre_of(fmu, manoeuvre_name, run_options.stop_time), fmu.variables)
        check_columns(fmu, manoeuvre)
        driver = driver_of(fmu, manoeuvre)
        manoeuvre, settings = apply_settings(fmu, manoeuvre, run_options.fmu_options)
        scene = scene_of(path, settings.start)
        result = run_with_bar(fmu, manoeuvre, communication_step(fmu, manoeuvre, run_options.step), driver)
    if scene is None:
        notes.append(_without_scene(path))
    else:
        scene = scene if driver is None else with_course(scene, driver.course)
        scene = with_marks(scene, result.marks, MARKS_OF_MANOEUVRE)
    notes += [": ".join(missed) for missed in result.missed]
    notes += result.remarks()
    if result.failed_steps and not result.ended:
        notes.append(f"{path} refused the step at {result.time[-1]:g} s; what came before is shown.")
    columns = {n: result.values[:, k] for k, n in enumerate(result.names)}
    title = name if manoeuvre_name is None else f"{name}, {manoeuvre.name.replace('_', ' ')}"
    recording = Recording(scene, result.time, columns, result.units, settings.title(title))
    recording.constants = fmu.table.constants(settings.start)
    return recording, notes, result.is_good
