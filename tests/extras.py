"""Each extra of the installation alone: does it bring what README and docs promise of it?

    python -m tests.extras [NAME ...]

One environment without extras and one for each extra gets a wheel of this clone (those of the clone itself: an editable
installation of a copy). In each every command runs, with good files and with files that are cut, empty or of another
format. It works, or says in one sentence which extra is missing or what is wrong with the file. `uv` is used where it
is there. The files are made here, which needs the extra `test`.
"""

import argparse
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from itertools import combinations
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ali3.commands import COMMANDS
from ali3.extras import extras
from tests.urdf.robots import UR5, write_urdf

ROOT = Path(__file__).resolve().parents[1]
UV = shutil.which("uv")

LINES = {
    "build": "--scene pendulum --kind native --platforms this --out built",
    "car": "hatchback",
    "run": "car.fmu -m inputs.csv --out driven",
    "view": "result.csv --geometry car.fmu --no-open",
    "simulator": "car.fmu --headless --stop-time 0.2",
    "check": "car.fmu --steps 5",
    "catalogue": "car.fmu --tests kerb --jobs 1 --out catalogue",
    "compare": "car.fmu result.csv --out compared",
    "study": "study.toml --jobs 1 --out studied",
    "road": "heights.csv heights.road --spacing 1 1",
}
"""Arguments with which each command does its work."""

BESIDES = (
    ("fmu", "build --kernel --out kernel"),
    ("hosts", "car hatchback --kinematics --points 5 --out kinematics"),
    ("hosts", "run kerb.fmu --kerb --fidelity 1 --out kerb"),
    ("hosts", "view car.fmu --live --no-open --out page"),
    ("simulator", "simulator --recording record --replay"),
    ("hosts", "check car.fmu --save-parameters all.ssv"),
    ("simulator", "check car.fmu --soak --stop-time 2 --drives 1 --jobs 1 --out soak"),
    ("", "road --world plane --out world"),
)
"""What commands do besides: the extra that it needs, and the line."""


class Reader(NamedTuple):
    """What reads files: a command or a Python statement, the extra that it needs, files that it reads."""

    extra: str
    what: str
    files: tuple[str, ...]
    bad: tuple[str, ...] = ("cut", "empty", "text", "bytes")


TABLE = ("empty", "text", "bytes")
"""A cut table is a shorter one."""

READERS = (
    Reader("hosts", "ali3 run {} --stop-time 0.1 --out ran", ("car.fmu",)),
    Reader("hosts", "ali3 check {} --steps 5", ("car.fmu",)),
    Reader("hosts", "ali3 run car.fmu -m {} --out driven", ("inputs.csv",), TABLE),
    Reader("hosts", "ali3 check car.fmu --show-parameters --parameters {}", ("car.ssv",)),
    Reader("hosts", "ali3 road heights.road --picture road.png", ()),
    Reader("hosts", "ali3 road --world plane --out world --picture world.png", ()),
    Reader("simulator", "ali3 simulator car.fmu --headless -m {}", ("inputs.csv",), TABLE),
    Reader("study", "ali3 compare car.fmu {} --out compared", ("result.csv",), TABLE),
    Reader("study", "ali3 study {} --dry-run", ("study.toml",), TABLE),
    Reader("roads", "ali3 road {} picture.road --range 0 1 --spacing 1 1", ("picture.png",)),
    Reader("roads", "ali3 road {} line.road", ("line.crg",)),
    Reader("roads", "ali3 road {} plate.road", ("plate.stl", "plate.obj", "plate.ply", "plate.off")),
    Reader(
        "pictures",
        "from ali3.scene.mesh_file import read_mesh; read_mesh('{}')",
        ("ball.stl", "ball.obj", "ball.ply", "ball.off", "ball.glb"),
    ),
    Reader(
        "pictures",
        "import mbs, mbs.scenes.pendulum as p; "
        "mbs.animate(mbs.simulate(mbs.compile(p.build()), t_end=0.2, h=0.01)).to_gltf('pendulum.glb')",
        (),
    ),
    Reader(
        "",
        "from mbs.flexible.nastran import read_nastran as r; r('{}', 'bar.op4')",
        ("bar.bdf",),
    ),
    Reader("", "from mbs.flexible.nastran import read_nastran as r; r('bar.bdf', '{}')", ("bar.op4",)),
    Reader(
        "fem",
        "import pathlib, shutil; from mbs.flexible.calculix import read_calculix; f = pathlib.Path('{}'); "
        "[shutil.copy(f'bar{{s}}', f'deck{{s}}') for s in ('.inp', '.sti', '.mas', '.dof')]; "
        "shutil.copy(f, f'deck{{f.suffix}}'); read_calculix('deck.inp')",
        ("bar.inp", "bar.sti", "bar.mas", "bar.dof"),
    ),
    Reader("urdf", "from mbs.urdf import read_urdf; read_urdf('{}')", ("arm.urdf",)),
)

OF_THE_CLONE = {
    "benchmarks": ("-c", "import benchmarks.cost, benchmarks.fmu, benchmarks.work_precision"),
    "docs": ("-m", "sphinx", "-W", "-q", "-b", "html", "docs", "site"),
    "peers": (
        "-c",
        "from benchmarks.peers import commonroad_car, drake_peer, exudyn_peer, mujoco_car, mujoco_peer, pinocchio_peer",
    ),
    "test": ("-m", "pytest", "-q", "-p", "no:cacheprovider", "tests/viewer/test_mesh_file.py", "tests/commands"),
    "viewer": ("-c", "from viewer.bundle import bundle; print(bundle())"),
}
"""What extras for a clone are for, as arguments of its Python."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Try the extras that are named, by default all."""
    known = ("none", *sorted(name for name in extras() if name not in ("", "dev")))
    parser = argparse.ArgumentParser(prog="python -m tests.extras", description=__doc__.partition("\n")[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"default: {', '.join(known)}")
    names = parser.parse_args(arguments).names or known
    if unknown := set(names) - set(known):
        parser.error(f"There is no extra {', '.join(sorted(unknown))}; there are {', '.join(known)}.")
    assert list(LINES) == [c.name for c in COMMANDS]
    bad = 0
    with tempfile.TemporaryDirectory() as temporary:
        work = Path(temporary)
        clone = _copy(work / "clone")
        subprocess.run(
            [sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "-w", work, clone], check=True, cwd=work
        )
        wheel = next(work.glob("ali3-*.whl"))
        _make_files(work / "files")
        print(f"{'extra':<11} {'install':>8} {'tried':>6} {'asked':>6} {'wrong':>6}", flush=True)
        for name in names:
            begin = time.monotonic()
            python = _environment(work / name, f"{clone if name in OF_THE_CLONE else wheel}", name)
            seconds = time.monotonic() - begin
            answers = list(_answers(name, python, work, clone))
            wrong = [message for _, message in answers if message]
            requested = sum(was_asked for was_asked, _ in answers)
            print(f"{name:<11} {seconds:>6.0f} s {len(answers):>6} {requested:>6} {len(wrong):>6}", flush=True)
            print("".join(f"  {message}\n" for message in wrong), end="", flush=True)
            bad += len(wrong)
            shutil.rmtree(work / name)
    return int(bad > 0)


def _answers(name: str, python: Path, work: Path, clone: Path) -> Iterator[tuple[bool, str]]:
    """Of each command and each reader: whether an extra was asked for, and what is wrong."""
    if name in OF_THE_CLONE:
        yield False, _wrong(_ran([python, *OF_THE_CLONE[name]], clone), 0, "")
        return
    files = work / f"files of {name}"
    shutil.copytree(work / "files", files)
    for extra, line in (*((c.extra, f"{c.name} {LINES[c.name]}") for c in COMMANDS), *BESIDES):
        yield _answer(name, extra, python, f"ali3 {line}", files)
    for reader in READERS:
        for file in reader.files or ("",):
            requested, message = _answer(name, reader.extra, python, reader.what.format(file), files)
            yield requested, message
            for how in () if requested or message or not file else reader.bad:
                done = _run(python, reader.what.format(f"{how}/{file}"), files)
                yield False, _wrong(done, 2, "")
    shutil.rmtree(files)


def _answer(name: str, extra: str, python: Path, what: str, files: Path) -> tuple[bool, str]:
    """Where the extra is there it works; elsewhere it is asked for, unless other extras have brought the same."""
    own = extras().get(name, set()) | extras()[""]
    done = _run(python, what, files)
    requested = done.returncode != 0 and not extras()[extra] <= own
    return requested, _wrong(done, 2 if requested else 0, f'"ali3[{extra}]"' if requested else "")


def _run(python: Path, what: str, files: Path) -> subprocess.CompletedProcess[str]:
    if what.startswith("ali3 "):
        return _ran([python, "-m", *shlex.split(what)], files)
    code = (
        "import sys; from ali3.command_run import run_command; from mbs.common.errors import ModelError; "
        f"sys.exit(run_command(lambda: exec({what!r}, {{}}) or 0, (ModelError,)))"
    )
    return _ran([python, "-W", "ignore", "-c", code], files)


def _ran(command: Sequence[str | Path], folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)


def _wrong(done: subprocess.CompletedProcess[str], status: int, message: str) -> str:
    """Empty, or the command with the end of what it said."""
    last = (done.stderr.strip().splitlines() or [""])[-1]
    sentence = status == 0 or (last.startswith("error: ") and message in last and ("ali3[" in last) == bool(message))
    if done.returncode == status and sentence and "No module named" not in done.stderr:
        return ""
    return f"{shlex.join(map(str, done.args[-4:]))}: exit code {done.returncode}, {last[-300:]}"


def _copy(folder: Path) -> Path:
    """The files of this clone that are not ignored."""
    listed = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"]
    for name in subprocess.run(listed, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split("\0"):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, folder / name)
    return folder


def _environment(folder: Path, what: str, name: str) -> Path:
    python = folder / ("Scripts/python.exe" if sys.platform == "win32" else "bin/python")
    requirement = what if name == "none" else f"{what}[{name}]"
    requirement = ["-e", requirement] if name in OF_THE_CLONE else [requirement]
    if UV:
        subprocess.run([UV, "venv", "-q", "--python", sys.executable, folder], check=True)
        subprocess.run([UV, "pip", "install", "-q", "--python", python, *requirement], check=True)
    else:
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
        subprocess.run([python, "-m", "pip", "install", "-q", *requirement], check=True)
    return python


def _make_files(folder: Path) -> None:
    """Good files, and bad ones of the same names in a folder for each way to be bad."""
    import trimesh
    from pyyeti.nastran import op4

    folder.mkdir()
    (folder / "inputs.csv").write_text('"time","steering","throttle","brake"\n0,0,0,0\n0.3,0.1,0.6,0\n')
    (folder / "heights.csv").write_text("0,0.1\n0,0.2\n")
    (folder / "study.toml").write_text(
        'fmu = "car.fmu"\n[[manoeuvres]]\nmanoeuvre = "inputs.csv"\n'
        '[sampling]\nmethod = "saltelli"\nruns = 2\nseed = 1\n'
        '[parameters]\n"front.tyre.grip" = { range = [0.8, 1.1] }\n"brakes.torque" = { range = [1000.0, 1100.0] }\n'
        '[measures]\npeak = "max(abs(chassis.ay))"\n[signals]\nnames = ["chassis.ay"]\ninterval = 0.02\n'
    )
    for line in (
        "build --kind native --platforms this,wasm32 --out dist",
        "build --scene kerb_test --kind native --platforms this --out dist",
        "run dist/PrototypeCar.fmu -m inputs.csv --out dist",
        "simulator dist/PrototypeCar.fmu --headless --stop-time 0.2 --record record",
        "road heights.csv heights.road --spacing 1 1",
    ):
        subprocess.run([sys.executable, "-m", "ali3", *line.split()], cwd=folder, check=True, capture_output=True)
    for built, name in (
        ("PrototypeCar.fmu", "car.fmu"),
        ("PrototypeCar.ssv", "car.ssv"),
        ("KerbTest.fmu", "kerb.fmu"),
        ("prototype_car_inputs.csv", "result.csv"),
    ):
        shutil.move(folder / "dist" / built, folder / name)
    Image.fromarray(np.arange(64, dtype=np.uint8).reshape(8, 8)).save(folder / "picture.png")
    ball = trimesh.creation.icosphere(1)
    for suffix in ("stl", "obj", "ply", "off", "glb"):
        ball.export(folder / f"ball.{suffix}")
    plate = trimesh.Trimesh([(0, 0, 0), (20, 0, 0.1), (20, 10, 0.1), (0, 10, 0)], [(0, 1, 2), (0, 2, 3)])
    for suffix in ("stl", "obj", "ply", "off"):
        plate.export(folder / f"plate.{suffix}")
    shutil.copy(ROOT / "tests" / "data" / "crg" / "handmade_straight_minimalist.crg", folder / "line.crg")
    for file in (ROOT / "tests" / "data" / "external").iterdir():
        shutil.copy(file, folder / file.name)
    nodes = np.array([(x, y, z) for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    lines = [f"GRID,{i + 1},,{x},{y},{z}" for i, (x, y, z) in enumerate(nodes)]
    (folder / "bar.bdf").write_text("\n".join(lines) + "\n")
    op4.write(str(folder / "bar.op4"), {"KGG": _springs(nodes), "MGG": np.eye(24)}, binary=False)
    write_urdf(UR5, folder / "arm.urdf")
    good = [file for file in folder.iterdir() if file.is_file()]
    noise = np.random.default_rng(1).bytes(2000)
    for how in ("cut", "empty", "text", "bytes"):
        (folder / how).mkdir()
        for file in good:
            data = file.read_bytes()
            bad = {"cut": data[: len(data) // 2], "empty": b"", "text": "é: no such format\n".encode("latin-1")}
            (folder / how / file.name).write_bytes(bad.get(how, noise))


def _springs(nodes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Stiffness (3 n, 3 n) of springs between all nodes (n, 3)."""
    K = np.zeros((nodes.size, nodes.size))
    for i, j in combinations(range(len(nodes)), 2):
        gap = np.zeros_like(nodes)
        gap[i] = (nodes[i] - nodes[j]) / np.linalg.norm(nodes[i] - nodes[j])
        gap[j] = -gap[i]
        K += np.outer(gap, gap)
    return K


if __name__ == "__main__":
    sys.exit(main())
