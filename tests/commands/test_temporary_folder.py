"""Temporary folders: the next program removes those of killed programs, and none of a running one."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from ali3.files import write_text
from ali3.folders import atomic_folder
from ali3.temporary_folder import PREFIX, temporary_folder

_HELD = """
import sys
from ali3.files import atomic_file
with atomic_file(sys.argv[1]) as made:
    made.write_text("half")
    print("held", flush=True)
    sys.stdin.read()
"""


def left(folder: Path) -> list[str]:
    return sorted(place.name for place in folder.iterdir() if place.name.startswith(PREFIX))


def holding(file: Path) -> subprocess.Popen[str]:
    """A program that is at work on a file."""
    process = subprocess.Popen([sys.executable, "-c", _HELD, str(file)], stdin=-1, stdout=-1, text=True)
    assert process.stdout is not None
    assert process.stdout.readline() == "held\n"
    return process


@pytest.mark.skipif(sys.platform == "win32", reason="locks of folders")
def test_files_left_by_a_kill_are_removed_with_the_next_file(tmp_path, monkeypatch):
    dead, alive = holding(tmp_path / "dead.txt"), holding(tmp_path / "alive.txt")
    try:
        assert len(left(tmp_path)) == 2
        dead.kill()
        dead.wait()
        (tmp_path / "linked").mkdir()
        (tmp_path / f"{PREFIX}link").symlink_to(tmp_path / "linked")
        monkeypatch.setattr("ali3.temporary_folder._cleared", set())
        write_text(tmp_path / "next.txt", "whole")
        assert len(left(tmp_path)) == 2  # of the one that lives, and the link
        assert alive.communicate("")[0] == ""
        assert alive.returncode == 0
    finally:
        for process in (dead, alive):
            process.kill()
            process.communicate()
    assert left(tmp_path) == [f"{PREFIX}link"]
    assert (tmp_path / "linked").is_dir()
    assert (tmp_path / "alive.txt").read_text() == "half"
    assert not (tmp_path / "dead.txt").exists()


def test_a_folder_goes_with_its_block(tmp_path):
    def work() -> None:
        with temporary_folder(tmp_path) as folder, atomic_folder(tmp_path / "made") as temporary:
            (folder / "a").write_text("x")
            (temporary / "b").write_text("x")
            assert len(left(tmp_path)) == 2
            raise ValueError("of the block")

    with pytest.raises(ValueError, match="of the block"):
        work()
    assert [place.name for place in tmp_path.iterdir()] == []
    with pytest.raises(OSError, match="gone"), temporary_folder(tmp_path / "gone"):
        pass


@pytest.mark.skipif(sys.platform != "linux", reason="the folder of a process and its guard")
def test_the_folder_of_a_process_whose_guard_is_killed_too_goes(tmp_path, monkeypatch):
    text = "from ali3.isolated_processes import Isolated; from tests.commands.test_isolated_processes import Counter; "
    text += "p = Isolated(Counter(), tuple[int, int]); p.do(''); print(p._process.process.pid, flush=True); input()"
    command = [sys.executable, "-c", text]
    program = subprocess.Popen(command, stdin=-1, stdout=-1, text=True, env=os.environ | {"TMPDIR": str(tmp_path)})
    assert program.stdout is not None
    guard = int(program.stdout.readline())
    os.kill(guard, 9)
    program.kill()
    program.communicate()
    assert len(left(tmp_path)) == 1
    monkeypatch.setattr("ali3.temporary_folder._cleared", set())
    with temporary_folder(tmp_path) as folder:
        assert left(tmp_path) == [folder.name]
