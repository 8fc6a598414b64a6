"""`ali3 check`: valid FMUs pass, faulty ones are named, other files are errors."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import fmpy
import pytest

from hosts.check.all_checks import CHECKS
from hosts.check.command import main
from hosts.check.instance import Instance, open_subject
from mbs.kernel import build
from tests import kinds
from tests.hosts.changed_fmu import DESCRIPTION, changed_fmu
from tests.in_process import run

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def fmus(scene_fmu: Callable[..., Path]) -> dict[str, Path]:
    scene = f"{ROOT / 'examples' / 'motor_pendulum.py'}:motor_pendulum"
    return {kind: scene_fmu(scene, kind) for kind in kinds.VERSIONS}


def check(fmu: Path) -> subprocess.CompletedProcess[str]:
    return run(main, fmu, "--steps", 10)


@pytest.mark.slow
@pytest.mark.parametrize("kind", kinds.VERSIONS)
def test_ours_pass(fmus: dict[str, Path], kind: str) -> None:
    done = check(fmus[kind])
    assert done.returncode == 0, done.stdout + done.stderr
    lines = done.stdout.splitlines()
    assert sum(line.startswith("  ok  ") for line in lines) == len(CHECKS)
    assert lines[-1].endswith("nothing bad found")


@pytest.mark.parametrize("options", [pytest.param(("--steps", 2), marks=pytest.mark.slow), ("--show-parameters",)])
def test_texts_without_an_end_are_cut(fmus: dict[str, Path], tmp_path: Path, options: tuple[object, ...]) -> None:
    def lengthened(description: bytes) -> bytes:
        description = description.replace(b'description="', b'description="' + 20_000 * b"x")
        return description.replace(b'modelName="', b'modelName="' + 100_000 * b"y")

    long = changed_fmu(fmus["native"], tmp_path / "long.fmu", {DESCRIPTION: lengthened})
    done = run(main, long, *options)
    assert done.returncode in (0, 1), done.stderr
    assert len(done.stdout) + len(done.stderr) < 60_000


def test_other_files_are_errors(tmp_path: Path) -> None:
    other = tmp_path / "other.fmu"
    other.write_text("no archive")
    assert "not an FMU" in check(other).stderr
    assert check(other).returncode == check(tmp_path / "none.fmu").returncode == 2


@pytest.mark.slow
def test_an_fmu_that_crashes_is_bad(fmus: dict[str, Path], tmp_path: Path) -> None:
    source = tmp_path / "crash.c"
    as_it_is_loaded = "__attribute__((constructor)) void crash(void) { raise(SIGSEGV); }\n"
    source.write_text("#include <signal.h>\n" + as_it_is_loaded)
    library = tmp_path / f"crash{fmpy.sharedLibraryExtension}"
    build.compile_c([source], build.host_target(), library, what="a library that crashes")
    name = fmpy.read_model_description(str(fmus["native"])).modelName
    inside = f"binaries/{fmpy.platform}/{name}{fmpy.sharedLibraryExtension}"
    copy = changed_fmu(fmus["native"], tmp_path / "crash.fmu", {inside: library.read_bytes()})
    done = check(copy)
    assert done.returncode == 1
    (bad,) = [line for line in done.stdout.splitlines() if line.startswith(" BAD")]
    assert bad[6:].startswith("functions")
    assert "crashed (SIGSEGV) in dlopen" in bad or sys.platform == "win32"


@pytest.mark.slow
def test_it_checks_with_set_values(tuned: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    command = [str(tuned), "--steps", "5", "--set", "spring.free_length=1.5", "--set", "pull=4"]
    assert main(command) == 0
    output = capfd.readouterr().out
    assert "set  spring.free_length      0.8 -> 1.5 m (--set)" in output
    assert "5 steps of" in output
    recorded = []
    for start in ({}, {"spring.free_length": 1.5, "pull": 4.0}):
        subject = open_subject(tuned, tmp_path / f"at{len(recorded)}", 5, start)
        recorded.append(Instance(subject).start().run(5))
    assert recorded[0] != recorded[1]


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="no limit of memory")
def test_an_fmu_without_memory_is_not_bad(fmus: dict[str, Path], tmp_path: Path) -> None:
    """What an FMU says is told as lack of memory, and an error that has another cause is not."""
    program = (
        "import resource, sys\n"
        "from pathlib import Path\n"
        "from hosts.check.all_checks import run_check\n"
        "from hosts.check.instance import Check, Instance, open_subject\n"
        "subject, crowd = open_subject(Path(sys.argv[1]), Path(sys.argv[2]), 10, {}), []\n"
        "used = int(Path('/proc/self/statm').read_text().split()[0]) * resource.getpagesize()\n"
        "resource.setrlimit(resource.RLIMIT_AS, (used + 30_000_000, resource.RLIM_INFINITY))\n"
        "print(run_check(Check('x', lambda subject: 1 / 0), subject).words)\n"
        "try:\n"
        "    crowded = lambda subject: [crowd.append(Instance(subject)) for _ in range(100_000)]\n"
        "    print(run_check(Check('crowd', crowded), subject))\n"
        "except MemoryError:\n"
        "    print('MemoryError')\n"
    )
    if not Path("/proc/self/statm").is_file():
        pytest.skip("no size of a process")
    command = [sys.executable, "-c", program, str(fmus["native"]), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    assert "ZeroDivisionError: division by zero\n" in done.stdout, done.stderr
    assert done.stdout.endswith("MemoryError\n"), done.stdout
