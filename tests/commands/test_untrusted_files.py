"""Any content in place of an expected file: the reader ends soon and reports the fault in one sentence."""

import importlib
import io
import os
import pickle
import random
import signal
import socket
import time
import tomllib
import warnings
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout
from pathlib import Path
from typing import Any

import pytest
import tomli_w

import mbs.roads
import mbs.vehicle
from ali3.alias_file import read_content
from ali3.commands import COMMANDS
from ali3.decimal_number import parse_number
from ali3.errors import FileError, UserError
from ali3.read_parameter_set import read_parameter_set
from ali3.reading import toml_of
from ali3.scene.mesh_file import read_mesh
from ali3.scene.scene import read_scene
from hosts.common.errors import HostError
from hosts.compare.log_aliases import Dialect, read_log_aliases
from hosts.compare.log_file import read_log
from hosts.driving.manoeuvre_file import read_manoeuvre
from hosts.fmu.geometry import RESOURCE, scene_of
from hosts.recordings.recorded_drive import read_recording
from hosts.recordings.recording_actions import show_recording
from hosts.simulator.devices.mapping_files import MappingFiles
from hosts.study.folder import read_record
from hosts.study.measures.user_function import read_user_function
from hosts.study.points import table_points
from hosts.study.study_file import read_study_file
from hosts.view.result_record import read_record as read_result_record
from hosts.view.result_tables import read_table as read_result
from mbs.flexible.bulk_data import grid_points
from mbs.flexible.calculix import calculix_matrices
from mbs.flexible.foreign_file import read_foreign
from mbs.flexible.matrix_files import read_matrix, read_model
from mbs.flexible.output4 import read_output4
from mbs.results.trajectory import Trajectory
from mbs.roads.description import described_road
from mbs.roads.grid_files import read_grid
from mbs.roads.read_road import read_road
from mbs.roads.road_file import RoadFile
from mbs.system.system import System
from mbs.vehicle.errors import CarFileError
from mbs.vehicle.kinematics.curve_files import read_curve
from mbs.vehicle.read_car import load
from mbs.vehicle.table import read_table as read_car_table
from mbs.worlds.course_file import read_course
from mbs.worlds.make_world import read_world
from tests.in_process import run

pytestmark = pytest.mark.skipif(os.name != "posix", reason="pipes, devices and alarms are those of POSIX")

LONGEST = 900  # characters of a sentence
SOON = 30  # s, after which a reader counts as one that does not end
DEEP = 3000
DIGITS = "9" * 5000
LARGE = "x" * 100_000
TOML = {
    "deep lists": "[" * DEEP + "]" * DEEP,
    "lists 150 deep": "[" * 150 + "]" * 150,
    "deep tables": "{a=" * DEEP + "1" + "}" * DEEP,
    "a key of many parts": "{" + "a." * 50_000 + "a = 1}",
    "5000 digits": DIGITS,
    "5000 digits of base 16": "0x" + "f" * 5000,
    "20 digits": "1" + "0" * 19,
    "no number": "nan",
    "infinite": "-inf",
    "a date": "1979-05-27",
    "a large text": f'"{LARGE}"',
    "a large key": f"{{ {LARGE} = 1 }}",
    "a large list": f"[{'1, ' * 50_000}]",
    "nothing": "",
}
JSON = {
    "deep lists": "[" * DEEP + "]" * DEEP,
    "lists 150 deep": "[" * 150 + "]" * 150,
    "deep tables": '{"a":' * DEEP + "1" + "}" * DEEP,
    "5000 digits": DIGITS,
    "20 digits": "1" + "0" * 19,
    "too large": "[1e999]",
    "a large text": f'"{LARGE}"',
    "a large key": f'{{"{LARGE}": 1}}',
    "a key twice": '{"a": 1, "a": 2}',
    "nothing": "",
}
CELLS = {
    "5000 digits": DIGITS,
    "a large text": LARGE,
    "no number": "nan",
    "underscores": "1_0",
    "an open quotation": '"1',
    "one more": "1,1",
    "nothing": "",
}
KINDS: dict[str, tuple[str, dict[str, str], str, Callable[[Path], Any]]] = {
    # kind: file, what stands for @ in it, a good one, its reader
    "car": ("car.toml", TOML, "schema = @\nname = 'x'\n", lambda path: load(path)),
    "alias file": ("a.toml", TOML, "steering = @\n", read_content),
    "alias file of a log": ("a.toml", TOML, "[signals]\nsteering = @\n", read_log_aliases),
    "study": ("s.toml", TOML, "car = 'prototype'\nstep = @\n[[manoeuvres]]\nstop_time = 1.0\n", read_study_file),
    "road in words": ("r.toml", TOML, "kind = 'plane'\nheight = @\n", described_road),
    "world": ("w.toml", TOML, "kind = 'world'\nname = 'w'\nbounds = @\n", read_world),
    "device": (
        "d.toml",
        TOML,
        "format = 'ALi3 device'\nversion = @\n",
        lambda path: MappingFiles(path.parent).read("d"),
    ),
    "scene": ("s.json", JSON, '{"format": "ALi3 scene", "version": @}', read_scene),
    "record of a study": ("study.json", JSON, '{"name": @}', lambda path: read_record(path.parent)),
    "record of a result": ("r.json", JSON, '{"fmu": "a.fmu", "set": @}', read_result_record),
    "recording": ("recording.json", JSON, '{"format": "ALi3 recording", "version": @}', read_recording),
    "events of a recording": ("events.jsonl", JSON, '{"kind": @, "time": 0, "text": ""}\n', lambda path: _rows(path)),
    "rows of a recording": (
        "inputs_outputs.csv",
        CELLS,
        "time,count,epoch,u\n0,0,0,@\n",
        lambda path: _rows(path),
    ),
    "rows in Parquet": ("inputs_outputs.parquet", {}, "PAR1", lambda path: _rows(path)),
    "manoeuvre": ("m.csv", CELLS, "time,steering\n0,0\n1,@\n", lambda path: read_manoeuvre(str(path))),
    "result": ("r.csv", CELLS, "time,u\n0,0\n1,@\n", read_result),
    "log": ("l.csv", CELLS, "time;u\n0;1\n1;2\n2;@\n", lambda path: _log(path)),
    "log in Parquet": ("l.parquet", {}, "PAR1", lambda path: read_log(path, Dialect())),
    "points of a study": ("p.csv", CELLS, "mass\n1\n@\n", lambda path: table_points(path, _variable, {})),
    "trajectory": ("t.csv", CELLS, "time [s],u [m]\n0,@\n", Trajectory.from_csv),
    "curve of an axle": ("front_parallel.csv", CELLS, "toe_angle_left [rad]\n@\n", read_curve),
    "table of a car": ("t.csv", CELLS, "joint,x\nA,@\n", lambda path: _car_table(path)),
    "course": ("c.csv", CELLS, "x,y\n0,0\n1,@\n", read_course),
    "grid": ("g.csv", CELLS, "0,0\n1,@\n", lambda path: read_grid(path, None, "heights")),
    "grid of NumPy": ("g.npy", {}, "\x93NUMPY", lambda path: read_grid(path, None, "heights")),
    "grid of a picture": ("g.png", {}, "PNG", lambda path: read_grid(path, (0.0, 1.0), "heights")),
    "OpenCRG": ("r.crg", {}, "$ROAD_CRG\nREFERENCE_LINE_INCREMENT = 1", read_road),
    "road of a mesh": ("r.ply", {}, "ply", read_road),
    "nodes": ("n.csv", CELLS, "name,x,y,z\nA,0,0,@\n", lambda path: read_model(path, path, path)),
    "matrix": ("k.mtx", {}, "%%MatrixMarket", read_matrix),
    "matrix of SciPy": ("k.npz", {}, "PK", read_matrix),
    "bulk data": ("a.bdf", {}, "GRID,1,,0.,@,0.\nINCLUDE 'b.bdf'\n", grid_points),
    "OUTPUT4": ("a.op4", {}, "       3", lambda path: read_foreign(path, read_output4)),
    "deck of CalculiX": ("a.inp", {}, "*NODE\n1,0.,0.,@\n*INCLUDE,INPUT=b\n", lambda path: _calculix(path)),
    "mesh of glTF": ("m.gltf", {}, '{"asset": {"version": "2.0"}, "buffers": [{"uri": "/dev/zero"}]}', read_mesh),
    "road": ("r.road", {}, "ALI3ROAD", lambda path: RoadFile(path).read()),
    "System": ("s.ali3", {}, "ALI3SYS", System.load),
    "mesh": ("m.stl", {}, "solid", read_mesh),
    "parameter set": ("p.ssv", {}, "<?xml version='1.0'?>", read_parameter_set),
    "function": ("f.py", {}, "def f(", lambda path: read_user_function(path, "f")),
}
_ANYTHING = "too large", "a large text", "a large key"
READ = {  # what is a file of the kind all the same
    "alias file": ("empty", "a large text"),
    "alias file of a log": ("empty", "a large text"),
    "device": ("missing",),
    "record of a study": ("missing", *_ANYTHING),
    "record of a result": ("too large",),
    # A last line without an end is left out.
    "events of a recording": ("missing", "empty", "zeros", "no UTF-8", "one line", "cut", "a large text"),
    "rows of a recording": ("no number",),
    "result": ("no number",),
    "log": ("no number", "one more", "nothing"),  # gaps of a logger, and the decimal comma
    "points of a study": ("nothing",),
    "trajectory": ("no number",),
    "curve of an axle": ("no number", "nothing"),
    "bulk data": ("cut",),
    "OUTPUT4": ("cut",),
    "deck of CalculiX": ("cut",),
}
MANY = ("car",)
"""Kinds of which all faults are told, a line each."""


def _rows(path: Path) -> list[Any]:
    """Reads a recording of which one file is the stranger's."""
    good = {
        "recording.json": '{"format": "ALi3 recording", "version": 2, "fmu": "a.fmu", "guid": "", "inputs": 1, '
        '"step": 0.01, "start": {}, "columns": ["u"], "every": [1], "units": {}, "closed": true}',
        "inputs_outputs.csv": "time,count,epoch,u\n0,0,0,1\n",
    }
    if path.suffix == ".parquet":
        del good["inputs_outputs.csv"]
    for name, text in good.items():
        if name != path.name:
            (path.parent / name).write_text(text)
    with redirect_stdout(io.StringIO()):
        show_recording(path.parent)
    return list(read_recording(path.parent).blocks())


def _log(path: Path) -> list[Any]:
    log = read_log(path, Dialect())
    return [log.numbers(name) for name in log.table]


def _calculix(path: Path) -> Any:
    for suffix in (".sti", ".mas", ".dof"):
        other = path.with_suffix(suffix)
        other.write_bytes(CALCULIX[suffix])
    return calculix_matrices(path)


def _car_table(path: Path) -> list[float]:
    return [row.number("x", -9.0, 9.0, "m") for row in read_car_table(path.parent, path.name, "frame.joints", ("x",))]


def _variable(name: str, where: str) -> Any:
    class Mass:
        kind, unit = "Real", "kg"

        def read(self, text: str, where: str) -> float:
            try:
                return parse_number(text)
            except ValueError as error:
                raise HostError(f"{where}: {error}.") from None

    if name != "mass":
        raise HostError(f"{where}: there is no {name[:60]!r}.")
    mass = Mass()
    mass.name = name  # type: ignore[attr-defined]
    return mass


def _places() -> dict[str, Callable[[Path, bytes], Any]]:
    """What may lie in a file's place, whatever its kind."""

    def a_socket(path: Path, _: bytes) -> None:
        with socket.socket(socket.AF_UNIX) as bound:
            here = Path.cwd()
            os.chdir(path.parent)  # the name of a socket is short
            bound.bind(path.name)
            os.chdir(here)

    noise = random.Random(1).randbytes(5000)
    return {
        "missing": lambda path, _: None,
        "a folder": lambda path, _: path.mkdir(),
        "a pipe": lambda path, _: os.mkfifo(path),
        "a socket": a_socket,
        "/dev/zero": lambda path, _: path.symlink_to("/dev/zero"),
        "/dev/tty": lambda path, _: path.symlink_to("/dev/tty"),
        "empty": lambda path, _: path.write_bytes(b""),
        "bytes": lambda path, _: path.write_bytes(noise),
        "zeros": lambda path, _: path.write_bytes(b"\0" * 5000),
        "UTF-16": lambda path, good: path.write_bytes(good.decode("latin-1").encode("utf-16")),
        "no UTF-8": lambda path, good: path.write_bytes(good + b"\xff\xfe"),
        "one line": lambda path, _: path.write_bytes(b"a" * 11_000_000),
        "cut": lambda path, good: path.write_bytes(good[: len(good) // 2]),
    }


TABLES = [kind for kind, (name, _, good, _) in KINDS.items() if name.endswith(".csv") and not good.startswith("0,")]


@pytest.mark.parametrize("kind", TABLES)
def test_a_heading_that_is_a_comment_keeps_its_meaning(tmp_path: Path, kind: str) -> None:
    """Nothing that a table says is passed over: it is read the same, or refused."""
    name, _, good, read = KINDS[kind]
    results = []
    for mark in ("", "# "):
        (tmp_path / name).write_text(mark + good.replace("@", "1"))
        try:
            results.append(pickle.dumps(read(tmp_path / name)))
        except (UserError, ValueError) as error:
            results.append(str(error).encode())
    assert results[0] == results[1]


class _Late(BaseException):
    """A reader has not ended; no reader takes it for an error of its file."""


@contextmanager
def _soon() -> Iterator[None]:
    def late(*_: object) -> None:
        raise _Late(f"it does not end within {SOON} s")

    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(SOON)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def fault_of(read: Callable[[Path], Any], path: Path, may_be_read: bool, many: bool = False) -> str:
    """What is wrong with how a reader refuses a file; empty where nothing is."""
    try:
        with _soon(), warnings.catch_warnings():
            warnings.simplefilter("error")
            read(path)
    except _Late as error:
        return str(error)
    except RecursionError:
        return "RecursionError"
    except Warning as told:  # of what is read all the same
        if path.name not in str(told):
            return f"{type(told).__name__}: {str(told)[:150]!r}"
    except Exception as error:
        text, where = str(error), type(error).__module__.split(".")[0]
        if where not in ("ali3", "hosts", "mbs", "viewer"):
            return f"{type(error).__name__}: {text[:150]!r}"
        if path.name not in text and path.stem not in text:
            return f"the file is not named: {text[:200]!r}"
        lines = text.split("\n") if many else [text]
        if any(len(line) > LONGEST or "\n" in line or not line.endswith((".", "?", ".)")) for line in lines):
            return f"no sentence, {len(text)} characters: {text[:200]!r}"
        return ""
    return "" if may_be_read else "it is read"


@pytest.mark.slow
def test_what_a_stranger_gives_is_refused_in_one_sentence(tmp_path: Path) -> None:
    """All readers, and all that may lie in the place of their files."""
    faults, count = [], 0
    for kind, (name, values, template, read) in KINDS.items():
        good = template.replace("@", "1").encode("latin-1")
        cases = {place: (put, good) for place, put in _places().items()}
        cases |= {value: (Path.write_bytes, template.replace("@", text).encode()) for value, text in values.items()}
        for case, (put, content) in cases.items():
            folder = tmp_path / f"{count}"
            folder.mkdir()
            count += 1
            put(folder / name, content)
            fault = fault_of(read, folder / name, case in READ.get(kind, ()), kind in MANY)
            faults += [f"{kind}, {case}: {fault}"] if fault else []
    assert not faults, f"{len(faults)} of {count}:\n" + "\n".join(faults)


def test_a_drawing_in_an_fmu_is_refused_in_one_sentence(tmp_path: Path) -> None:
    faults = []
    for case, text in JSON.items():
        file = tmp_path / f"{case.replace(' ', '_')}.fmu"
        with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr(RESOURCE, '{"format": "ALi3 scene", "version": 1, "frames": @}'.replace("@", text))
        fault = fault_of(scene_of, file, may_be_read=False)
        faults += [f"{case}: {fault}"] if fault else []
    assert not faults, "\n".join(faults)


CALCULIX = {
    ".sti": b"".join(b"%d %d %e\n" % (k, k, 1e6) for k in range(1, 7)),
    ".mas": b"".join(b"%d %d %e\n" % (k, k, 2.0) for k in range(1, 7)),
    ".dof": b"1.1\n1.2\n1.3\n2.1\n2.2\n2.3\n",
}


WHOLE = {  # every key that its kind has, or an example
    "alias file of a log": """
[file]
delimiter = ";"
decimal = ","
encoding = "utf-8"
heading = 1
units = 2
[time]
name = "t"
unit = "s"
factor = 1.0
offset = 0.0
[signals]
a = { name = "c", unit = "m", factor = 2.0, offset = 1.0, time = "t2" }
""",
    "road in words": (Path(mbs.roads.__file__).parent / "files" / "rough.toml").read_text(),
    "manoeuvre": """
stop_time = 1.0
held = ["brake"]
[inputs]
time = [0.0, 1.0]
brake = [0.0, 1.0]
[start]
mass = 1.0
[driver]
course = "iso"
""",
    "device": """
format = "ALi3 device"
version = 1
serial = "1"
[settings]
gain = 1.0
[inputs.steering]
source = "axis 0"
low = -1.0
high = 1.0
inverted = false
dead_zone = 0.0
centre = 0.0
""",
}
OTHERS: tuple[Any, ...] = ([], ["s"], {}, {"a": 1}, True, -1, 1e300, "", "s")


def _with_others(value: Any) -> Iterator[Any]:
    """What a value may be replaced by: a value of another kind, or itself with one value inside replaced."""
    yield from OTHERS
    for key in value if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ():
        for other in _with_others(value[key]):
            copy = value.copy()
            copy[key] = other
            yield copy


@pytest.mark.parametrize("kind", WHOLE)
def test_each_value_may_be_of_another_kind(kind: str, tmp_path: Path) -> None:
    read, file, faults = KINDS[kind][3], tmp_path / "d.toml", []
    documents = [part for part in _with_others(tomllib.loads(WHOLE[kind])) if isinstance(part, dict)]
    for document in documents:
        file.write_text(tomli_w.dumps(document))
        fault = fault_of(read, file, may_be_read=True)
        faults += [f"{fault}: {document}"] if fault else []
    assert len(documents) > 60
    assert not faults, f"{len(faults)} of {len(documents)}:\n" + "\n".join(faults[:10])


@pytest.mark.parametrize("kind", ["car", "log", "record of a result"])
@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-be"])
def test_a_text_in_another_encoding_is_called_so(kind: str, encoding: str, tmp_path: Path) -> None:
    name, _, template, read = KINDS[kind]
    (tmp_path / name).write_bytes(template.replace("@", "1").encode(encoding))
    with pytest.raises((UserError, CarFileError), match=r"is written in UTF-16; it must be in UTF-8\."):
        read(tmp_path / name)


@pytest.mark.parametrize("command", ["run", "check", "view", "compare", "catalogue", "simulator", "view --geometry"])
def test_a_pipe_in_the_place_of_an_fmu_is_called_so(command: str, tmp_path: Path) -> None:
    pipe, table = tmp_path / "a.fmu", tmp_path / "r.csv"
    os.mkfifo(pipe)
    table.write_text("time,u\n0,0\n1,0\n")
    name, *option = command.split()
    more = {"compare": [table], "simulator": ["--headless", "--stop-time", "1"]}.get(name, [])
    message = [table, *option, pipe, "--no-open"] if option else [pipe, *more]
    main = next(c for c in COMMANDS if c.name == name).module
    with _soon():
        done = run(importlib.import_module(main).main, *message)
    assert done.returncode == 2
    assert done.stderr.strip().endswith(f"error: {pipe} is a pipe or device; it must be a file.")


DOTS = 250 * "."


@pytest.mark.parametrize(
    "text",
    [
        f'a = """\n{DOTS}\n"""',
        f'a = """x\\"""{DOTS}"""""',
        f"a = '''\n{DOTS}\n'''",
        f'a = "\\"{DOTS}"',
        f"a = 1  # {DOTS}",
    ],
)
def test_dots_of_strings_and_comments_are_not_dots_of_a_key(text: str) -> None:
    assert toml_of(text.encode(), FileError, "a.toml") == tomllib.loads(text)


@pytest.mark.parametrize("prefix", ['a = """b"""""\n', "a = '''b'''\n", 'a = "\\\\"\n', '"".'])
def test_a_key_of_many_parts_behind_a_string_is_refused(prefix: str) -> None:
    with pytest.raises(FileError, match="a key has more than 200 parts"):
        toml_of(f"{prefix}{300 * 'a.'}a = 1".encode(), FileError, "a.toml")


@pytest.mark.parametrize("part", ['\n\\"""', '"\\', "'''\n", '\\"'])
def test_strings_without_an_end_are_refused_soon(part: str) -> None:
    start = time.process_time()
    with pytest.raises(FileError, match=r"is not a TOML file"):
        toml_of(f'a = """\n{part * (900_000 // len(part))}'.encode(), FileError, "a.toml")
    assert time.process_time() - start < 2.0


def test_whole_numbers_of_toml_have_64_bits() -> None:
    assert toml_of(f"a = {-(2**63)}".encode(), FileError, "a.toml") == {"a": -(2**63)}
    for number in (2**63, -(2**63) - 1):
        with pytest.raises(FileError, match="a is a whole number that 64 bits cannot hold"):
            toml_of(f"a = {number}".encode(), FileError, "a.toml")
