"""The console command: one table, quick help, names as the user typed them, and no harm by files of the user."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

import ali3
from ali3 import running
from ali3.command import main
from ali3.commands import COMMANDS

ROOT = Path(ali3.__file__).parents[1]
# What an installation writes into the folder of programs.
SCRIPT = "import sys\nfrom ali3.command import main\nif __name__ == '__main__':\n    sys.exit(main())\n"
# Names of ours, of what we import, and of the standard library.
NAMES = (
    *("ali3", "mbs", "fmu_src", "hosts", "benchmarks", "build_fmu", "numpy", "scipy", "fmpy", "matplotlib", "tqdm"),
    *("ziglang", "pythonfmu", "argparse", "csv", "configparser", "json", "random", "subprocess", "tempfile", "types"),
    *("typing", "zipfile", "ctypes", "dataclasses", "signal", "threading", "platform", "queue", "test", "run", "check"),
)
HEAVY = ("numpy", "scipy", "fmpy", "matplotlib", "mbs", "fmu_src", "hosts")


@pytest.fixture
def script(tmp_path: Path) -> Path:
    (tmp_path / "bin").mkdir()
    file = tmp_path / "bin" / "ali3"
    file.write_text(SCRIPT)
    return file


@pytest.fixture
def crowded(tmp_path: Path) -> Path:
    """A folder whose files stop whoever imports them."""
    folder = tmp_path / "crowded"
    folder.mkdir()
    for name in NAMES:
        (folder / f"{name}.py").write_text(f"raise SystemExit('{name}.py of the user was imported')\n")
    return folder


def ran(command: list[object], folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, *map(str, command)], capture_output=True, text=True, check=False, cwd=folder)


@pytest.mark.parametrize("command", COMMANDS, ids=lambda c: c.name)
def test_each_command_helps_under_its_name(command: object, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main([command.name, "--help"])
    assert end.value.code == 0
    assert capsys.readouterr().out.startswith(f"usage: ali3 {command.name} ")


def test_each_command_is_in_the_documents() -> None:
    page = (ROOT / "docs" / "commands.md").read_text(encoding="utf-8")
    rows = [line.split("|")[1:3] for line in page.splitlines() if line.startswith("| `ali3 ")]
    assert [name.strip(" `") for name, _ in rows] == [f"ali3 {c.name}" for c in COMMANDS]
    assert all(text.strip().startswith(c.text) for (_, text), c in zip(rows, COMMANDS, strict=True))


def test_the_list_of_commands_imports_nothing_heavy(tmp_path: Path) -> None:
    text = "import sys; from ali3.command import main\ntry: main(['--help'])\nfinally: print('\\n', *sys.modules)"
    done = ran(["-c", text], tmp_path)
    assert all(f"\n  {c.name} " in done.stdout for c in COMMANDS)
    assert all(c.text in done.stdout for c in COMMANDS)
    assert not set(HEAVY) & set(done.stdout.split("\n ")[-1].split())


def test_a_command_that_is_none(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["biuld"]) == 2
    assert "no command 'biuld'. Did you mean 'build'?" in capsys.readouterr().err
    assert main(["zzz"]) == 2
    assert "The commands are build, car, drive" in capsys.readouterr().err
    assert main([]) == 2


def test_messages_name_the_command_that_was_typed(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(running, "_prefix", None)
    monkeypatch.chdir(tmp_path)
    assert main(["kerb"]) == 2
    assert "Build it with: ali3 build --scene kerb_test" in capsys.readouterr().err
    assert main(["drive", "-m", "slalom"], prog="python -m ali3") == 2
    assert "Build it with: python -m ali3 build" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["drive"])
    assert "ali3 drive: error: the following arguments are required" in capsys.readouterr().err


def test_a_missing_extra_is_reported_with_the_line_that_installs_it(tmp_path: Path) -> None:
    (tmp_path / "some.fmu").write_text("")
    text = "import sys; sys.modules['fmpy'] = None; from ali3.command import main; sys.exit(main(['run', 'some.fmu']))"
    done = ran(["-c", text], tmp_path)
    assert done.returncode == 2
    assert done.stderr == ('error: The package fmpy is not installed; run: python -m pip install "ali3[hosts]"\n')


def test_files_of_the_user_cannot_break_a_command(script: Path, crowded: Path) -> None:
    done = ran([script, "build", "--scene", "pendulum", "--kind", "native", "--platforms", "this"], crowded)
    assert done.returncode == 0, done.stderr
    assert (crowded / "dist" / "Pendulum.fmu").is_file()
    done = ran([script, "run", "dist/Pendulum.fmu", "--stop-time", 1], crowded)
    assert done.returncode == 0, done.stderr
    assert (crowded / "out" / "Pendulum.csv").is_file()
    done = ran([script, "run", "dist/Pendulum.fmu", "--stop-time", -1], crowded)
    assert (done.returncode, done.stderr) == (2, "error: The stop time is -1 s; it must be positive.\n")
    done = ran([script, "check", "dist/Pendulum.fmu", "--steps", 3], crowded)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "nothing bad found" in done.stdout
    done = ran([script, "drive", "-m", "double_lane_change", "dist/Pendulum.fmu"], crowded)
    assert done.returncode == 2
    assert "The driver needs variables" in done.stderr


def test_as_a_module_it_forgets_the_current_folder(crowded: Path) -> None:
    # Python itself looks for these before it starts the module
    for name in ("ali3", "types", "typing", "test", "threading"):
        (crowded / f"{name}.py").unlink()
    done = ran(["-m", "ali3", "run", "none.fmu"], crowded)
    assert (done.returncode, done.stderr) == (2, "error: There is no file none.fmu.\n")


def test_an_installed_project_of_the_user_stays_in_the_search_path(tmp_path: Path) -> None:
    text = (
        "import os, sys, sysconfig; here = os.getcwd(); library = sysconfig.get_path('stdlib')\n"
        "sys.path[:] = [here, library, here]\n"
        f"sys.path.append({str(ROOT)!r})\n"
        "from ali3.search_path import forget_current_folder as forget\n"
        "forget(); print(sys.path == [library, here, sys.path[-1]])\n"
        "os.environ['PYTHONPATH'] = here; sys.path.insert(0, here); forget(); print(sys.path[0] == here)"
    )
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    command = [sys.executable, "-c", text]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=tmp_path, env=environment)
    assert done.stdout.split() == ["True", "True"]


def test_the_modules_themselves_go_on_working_in_a_clone() -> None:
    for module in (
        "hosts.run.drive",
        "hosts.run.run",
        "hosts.check.command",
        "hosts.run.kerb",
        "mbs.kernel.build",
        "ali3",
    ):
        done = ran(["-m", module, "--help"], ROOT)
        assert done.returncode == 0, done.stderr
        assert done.stdout.startswith(f"usage: python -m {module} ")
    assert ran(["build_fmu.py", "--help"], ROOT).stdout.startswith("usage: python build_fmu.py ")
