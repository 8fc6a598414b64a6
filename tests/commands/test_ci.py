"""The values that `.ci/run` reads from README.md."""

import subprocess
import sys
from pathlib import Path

import pytest

CI = Path(__file__).parents[2] / ".ci"


@pytest.mark.parametrize(("number", "message"), [("1", ["ali3 build", "ali3 run"]), ("2", ['".[test]"', "-m pytest"])])
def test_the_commands_of_the_readme(number, message):
    command = [sys.executable, CI / "readme_command.py", number]
    line = subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    assert line.startswith("python3 -m venv .venv && .venv/bin/python -m pip install -e ")
    assert all(word in line for word in message)
