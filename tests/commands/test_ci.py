"""The values that `.ci/run` reads from README.md and from the output of the tests."""

import subprocess
import sys
from pathlib import Path

import pytest

from tests.modules import module_of

CI = Path(__file__).parents[2] / ".ci"
SECTION = """\
    python3 early

## Two commands

    python3 -m venv .venv && one

    other

{}## Next

    python3 late
"""


@pytest.mark.parametrize(("number", "message"), [("1", ["ali3 build", "ali3 run"]), ("2", ['".[test]"', "-m pytest"])])
def test_the_commands_of_the_readme(number, message):
    command = [sys.executable, CI / "readme_command.py", number]
    line = subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    assert line.startswith("python3 -m venv .venv && .venv/bin/python -m pip install -e ")
    assert all(word in line for word in message)


def test_two_commands_and_no_other_number(tmp_path, monkeypatch, capsys):
    reader = module_of(CI / "readme_command.py")
    file = tmp_path / "README.md"
    file.write_text(SECTION.format("    pyhton3 -m venv\n\n"))
    monkeypatch.setattr(reader, "README", file)
    assert reader.main() == 1
    assert "there must be two" in capsys.readouterr().err
    assert reader.commands(SECTION.format("    python3 two\n\n")) == ["python3 -m venv .venv && one", "python3 two"]


def test_files_skipped_for_want_of_a_package():
    log = """SKIPPED [1] tests/a/test_x.py:74: could not import 'mypy': No module named 'mypy'
SKIPPED [2] tests/b/test_y.py:3: extra 'fem'
SKIPPED [1] tests/b/test_y.py:9: extra 'fem'
SKIPPED [1] tests/c/test_z.py:88: CalculiX (ccx) is not installed
SKIPPED [1] tests/c/test_w.py:1: The package imageio is not installed; run: python -m pip install "ali3[pictures]"
"""
    actual = module_of(CI / "skipped_for_packages.py").files(log)
    assert actual == ["tests/a/test_x.py", "tests/b/test_y.py", "tests/c/test_w.py"]
