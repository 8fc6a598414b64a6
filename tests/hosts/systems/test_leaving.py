"""A process that ran an FMU leaves no files or processes, and reads no freed memory."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from ali3.temporary_folder import PREFIX
from tests.quick import quick

ROOT = Path(__file__).parents[3]
PROGRAM = """
import sys
from pathlib import Path
from hosts.fmu.fmu import Fmu
fmu = Fmu(Path(sys.argv[1]))
fmu.initialise({})
fmu.step(0.0, 0.1)
if sys.argv[2] == "closed":
    fmu.close()
print("stepped")
"""


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("valgrind") is None, reason="valgrind is not installed; .ci/run installs it")
@pytest.mark.parametrize("end", quick(("closed",), ("closed", "left open"), "proof"))
def test_the_record_of_python_is_freed_once(partners, end):
    """Seen by valgrind: with PythonFMU 0.7 alone one run of about 40 ends with a damaged heap."""
    memory = ("--num-callers=8", "--undef-value-errors=no", "--leak-check=no")  # what is freed, in half the time
    command = ["valgrind", *memory, sys.executable, "-c", PROGRAM, str(partners["half_mass"]), end]
    environment = os.environ | {"PYTHONMALLOC": "malloc", "PYTHONPATH": str(ROOT)}
    completed = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert completed.returncode == 0, completed.stderr[-2000:]
    assert completed.stdout.strip() == "stepped"
    assert "finalizePythonInterpreter" not in completed.stderr


def test_what_was_unpacked_goes_with_a_process_that_does_not_close(scene_fmu, tmp_path):
    """A script or a notebook that only ends must not fill the folder for temporary files, 4 MB for each start."""
    fmu = scene_fmu(f"{Path(__file__).parents[1] / 'scenes.py'}:sledge")
    environment = os.environ | {"TMPDIR": str(tmp_path), "TEMP": str(tmp_path), "PYTHONPATH": str(ROOT)}
    program = f"{PROGRAM}print(*__import__('os').listdir({str(tmp_path)!r}))"
    completed = subprocess.run(
        [sys.executable, "-c", program, str(fmu), "left open"],
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    assert PREFIX in completed.stdout
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are not forked here")
def test_it_stays_where_a_forked_process_ends_and_closing_twice_is_closing(scene_fmu, tmp_path):
    fmu = scene_fmu(f"{Path(__file__).parents[1] / 'scenes.py'}:sledge")
    environment = os.environ | {"TMPDIR": str(tmp_path), "PYTHONPATH": str(ROOT)}
    program = f"""{PROGRAM}
import os
if os.fork() == 0:
    sys.exit()
os.wait()
print(len(os.listdir({str(tmp_path)!r})))
fmu.close()
fmu.close()
print(len(os.listdir({str(tmp_path)!r})))
"""
    command = [sys.executable, "-u", "-c", program, str(fmu), "left open"]
    completed = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert completed.stdout.split() == ["stepped", "1", "0"]
