"""Commands with an FMU that ends its process or gives no numbers; none of them loads a library of an FMU itself."""

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from hosts.check.command import main as check
from hosts.compare.command import main as compare
from hosts.fmu.instance import Instance
from hosts.simulator.command import main as simulator
from hosts.study.command import main as study
from hosts.study.store import read_study
from hosts.view.command import main as view
from tests.hosts.odd_fmus import odd_fmu
from tests.hosts.test_foreign_fmus import CRASH, LEAVE, NOT_A_NUMBER
from tests.in_process import run

pytestmark = [pytest.mark.slow, pytest.mark.skipif(sys.platform != "linux", reason="signals, and FMUs for Linux")]
_WORDS = {
    LEAVE: "ended with exit code 0 in fmi2DoStep at 0.04 s",
    CRASH: "crashed (SIGSEGV) in fmi2DoStep at 0.04 s",
    NOT_A_NUMBER: "The output 'y' is nan at 0.05 s.",
}


@pytest.fixture(scope="module")
def faults(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return odd_fmu("faults", tmp_path_factory.mktemp("faults"))


@pytest.fixture(autouse=True)
def unloaded(monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*_: object) -> None:
        raise AssertionError("the library of an FMU is loaded in the process of the command")

    monkeypatch.setattr(Instance, "__init__", never)


def table(out: Path, fault: int) -> Path:
    """A log of the FMU as it should be."""
    rows = [f"{0.01 * k:.2f},{fault},{0.01 * k + 0.001 * (k % 7):.4f}" for k in range(201)]
    out.mkdir(exist_ok=True)
    file = out / f"log_{fault}.csv"
    file.write_text("\n".join(["time,u,y", *rows, ""]))
    return file


_SIMULATED = ("--headless", "--stop-time", 0.1, "--step", 0.01)
COMMANDS: dict[str, Callable[[Path, Path, int], tuple[object, ...]]] = {
    "view": lambda fmu, out, fault: (view, fmu, "--set", f"u={fault}", "--out", out, "--no-open", "--plot", "y"),
    "compare": lambda fmu, out, fault: (compare, fmu, table(out, fault), "--out", out),
    "reference": lambda fmu, out, fault: (check, fmu, "--reference", table(out, fault), "--bound", "y=1"),
    "simulator": lambda fmu, out, fault: (simulator, fmu, *_SIMULATED, "--set", f"u={fault}"),
}


@pytest.mark.parametrize(
    ("command", "fault"),
    [(command, CRASH) for command in COMMANDS] + [(command, NOT_A_NUMBER) for command in ("compare", "simulator")],
)
def test_it_is_reported_once_and_the_exit_code_is_1(faults: Path, tmp_path: Path, command: str, fault: int) -> None:
    main, *arguments = COMMANDS[command](faults, tmp_path / "out", fault)
    done = run(main, *arguments)  # type: ignore[arg-type]
    assert done.returncode == 1, done.stdout + done.stderr
    assert (done.stdout + done.stderr).count(_WORDS[fault]) == 1, done.stdout + done.stderr


def test_a_study_tells_it_of_its_runs(faults: Path, tmp_path: Path) -> None:
    file = tmp_path / "study.toml"
    file.write_text(
        f'fmu = "{faults}"\n[[manoeuvres]]\nname = "stand"\nstop_time = 0.1\n[sampling]\nmethod = "grid"\n'
        '[parameters]\nu = { values = [0.0, 1.0, 2.0, 3.0] }\n[measures]\ntop = "max(y)"\n'
    )
    done = run(study, file, "--out", tmp_path / "out", "--no-report", "--jobs", 1)
    assert done.returncode == 0, done.stderr  # every run has its row
    assert "3 failed" in done.stdout
    reasons = read_study(tmp_path / "out")["reason"]
    assert [sum(message in str(reason) for reason in reasons) for message in _WORDS.values()] == [1, 1, 1]


def test_a_recording_is_repeated_in_another_process(faults: Path, tmp_path: Path) -> None:
    folder, part = tmp_path / "drive", tmp_path / "part.csv"
    assert run(simulator, faults, *_SIMULATED, "--record", folder).returncode == 0
    replayed = run(simulator, "--recording", folder, "--replay")
    assert (replayed.returncode, replayed.stdout) == (0, "11 rows, the same bits in all of them\n")
    requested = ("--recording", folder, "--save-manoeuvre", part, "--from", 0.06)
    for options in (("--recording", folder, "--replay"), requested):
        done = run(simulator, odd_fmu("crashing", tmp_path), *options)
        message = "error: The process of the FMU crashed (SIGSEGV) in fmi2DoStep at 0.02 s.\n"
        assert (done.returncode, done.stderr) == (1, message)
    assert not part.exists()
    saved = run(simulator, *requested)
    assert saved.returncode == 0, saved.stderr
    assert part.is_file()
    assert part.with_suffix(".state").is_file()


def test_tables_of_a_folder_are_compared_up_to_a_crash_and_the_others_whole(faults: Path, tmp_path: Path) -> None:
    folder = tmp_path / "tables"
    for fault in (0, CRASH):
        table(folder, fault)
    done = run(check, faults, "--reference", folder, "--bound", "y=1", "--jobs", 2)
    assert done.returncode == 1
    assert f"{folder / 'log_0.csv'}, 1 signals up to 2 s in steps of 0.01 s: all within their bounds" in done.stdout
    assert f"{folder / f'log_{CRASH}.csv'}, 1 signals up to 0.04 s" in done.stdout
    assert f"The reference goes on to 2 s, but the process of the FMU {_WORDS[CRASH]}; 5 rows were kept." in done.stdout


def test_a_table_with_which_the_fmu_does_not_start_does_not_end_the_others(tmp_path: Path) -> None:
    """Its library takes no value of the parameter, which one of three tables has."""
    inside, kind = '<ScalarVariable name="y"', 'valueReference="2" causality="parameter" variability="tunable"'
    parameter = f'<ScalarVariable name="p" {kind}><Real start="0"/></ScalarVariable>'
    changes = {inside: parameter + inside, 'index="2"': 'index="3"'}
    fmu, folder = odd_fmu("faults", tmp_path, changes=changes), tmp_path / "tables"
    for fault in (0, 10, 20):
        table(folder, fault)
    refused = folder / "log_10.csv"
    refused.write_text(refused.read_text().replace(",10,", ",10,1,").replace("time,u,y", "time,u,p,y"))
    done = run(check, fmu, "--reference", folder, "--bound", "y=1", "--jobs", 1)
    assert done.returncode == 2, done.stdout + done.stderr
    assert done.stdout.count("all within their bounds") == 2, done.stdout + done.stderr
    assert "BAD   log_10.csv: The FMU could not be initialised: fmi2SetReal failed" in done.stdout
