"""Files are written completely or not at all, also by two writers at once; a full disk is reported."""

import json
import subprocess
import sys
import threading
import zipfile
from pathlib import Path

import pytest

import mbs
from ali3.files import FileError, atomic_file, check_folder, check_writable, make_folder, write_json, write_text
from ali3.folders import atomic_folder
from ali3.locks import locked
from fmu_src.build import command as build
from fmu_src.native.archive import write_zip
from mbs.scenes import pendulum

FULL = """
import resource, signal, sys
from pathlib import Path
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))
from ali3.files import FileError
from fmu_src.build import command as build
from fmu_src.native.archive import write_zip
import random
try:
    write_zip({"modelDescription.xml": random.Random(1).randbytes(100_000)}, Path(sys.argv[1]))
except FileError as error:
    print(error)
"""


def names(folder: Path) -> list[str]:
    return sorted(p.name for p in folder.iterdir())


def fail_half_way(file: Path, error: type[BaseException]) -> None:
    with atomic_file(file) as temporary:
        temporary.write_text("half")
        raise error


def test_a_file_is_replaced_when_the_new_one_is_whole(tmp_path: Path) -> None:
    file = tmp_path / "a" / "table.csv"
    with atomic_file(file) as temporary:
        temporary.write_text("one")
        assert not file.exists()
    with atomic_file(file) as temporary:
        temporary.write_text("two")
        assert temporary.suffix == ".csv"
        assert file.read_text() == "one"
    assert file.read_text() == "two"
    assert names(file.parent) == ["table.csv"]


def test_an_error_inside_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    file = tmp_path / "table.csv"
    file.write_text("old")
    for error in (ValueError, KeyboardInterrupt):
        with pytest.raises(error):
            fail_half_way(file, error)
    assert file.read_text() == "old"
    assert names(tmp_path) == ["table.csv"]


def test_the_mode_is_that_of_any_new_file(tmp_path: Path) -> None:
    (tmp_path / "plain").write_text("")
    with atomic_file(tmp_path / "whole") as temporary:
        temporary.write_text("")
    assert (tmp_path / "whole").stat().st_mode == (tmp_path / "plain").stat().st_mode


@pytest.mark.skipif(sys.platform == "win32", reason="links need rights there")
def test_a_link_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "real" / "file")
    with atomic_file(tmp_path / "link") as temporary:
        temporary.write_text("x")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "real" / "file").read_text() == "x"


@pytest.mark.parametrize("write", [check_writable, lambda f: atomic_file(f).__enter__()], ids=["check", "write"])
def test_a_file_that_cannot_be_written_is_named(write: object, tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match=r"folder is a folder; it must be a file\.$"):
        write(tmp_path / "folder")
    with pytest.raises(FileError, match=r"^The folder .*in cannot be made"):
        write(tmp_path / "file" / "in" / "x.csv")
    if sys.platform != "win32":  # links need rights there
        (tmp_path / "loop").symlink_to(tmp_path / "back")
        (tmp_path / "back").symlink_to(tmp_path / "loop")
        with pytest.raises(FileError, match=r"loop cannot be written: it is a link that leads back to itself\.$"):
            write(tmp_path / "loop")
        with pytest.raises(FileError, match=r"loop cannot be made: .*loop is a link that leads to no folder\.$"):
            make_folder(tmp_path / "loop")
    if sys.platform == "linux":
        with pytest.raises(FileError, match=r"^/proc/x\.csv cannot be written: "):
            write(Path("/proc/x.csv"))


def test_a_folder_that_cannot_be_made_is_named_before_the_work(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("")
    check_folder(tmp_path / "new" / "folder")
    assert not (tmp_path / "new").exists()
    for folder, reason in ((tmp_path / "file", "is a file"), (tmp_path / ("x" * 5000), "file name too long")):
        with pytest.raises(FileError, match=f" cannot be .*{reason}\\.$"):
            check_folder(folder)
        assert build.main(["prototype", "--out", str(folder)]) == 2
        printed = capsys.readouterr()
        assert reason in printed.err
        assert not printed.out, "no work has begun"


def test_a_system_and_a_trajectory_are_written_whole(tmp_path: Path) -> None:
    system = mbs.compile(pendulum.build())
    run = mbs.simulate(system, 0.1, 0.01)
    for name, save in (("a.ali3", system.save), ("a.csv", run.to_csv)):
        save(tmp_path / name)
        with pytest.raises(FileError, match=r"none.* cannot be written: no such file or directory\.$"):
            save(tmp_path / "none" / name)
    assert names(tmp_path) == ["a.ali3", "a.csv"]
    assert mbs.System.load(tmp_path / "a.ali3").to_bytes() == system.to_bytes()


@pytest.mark.skipif(sys.platform == "win32", reason="there is no such limit")
def test_a_full_disk_names_the_file_and_leaves_nothing(tmp_path: Path) -> None:
    file = tmp_path / "Some.fmu"
    file.write_text("old")
    done = subprocess.run([sys.executable, "-c", FULL, str(file)], capture_output=True, text=True, check=True)
    assert done.stdout == f"{file} cannot be written: file too large.\n"
    assert done.stderr == ""
    assert file.read_text() == "old"
    assert names(tmp_path) == ["Some.fmu"]


def test_a_text_with_a_name_that_is_no_text_is_written(tmp_path: Path) -> None:
    write_json(tmp_path / "a.json", {"file": "b\udcff ä"})
    assert json.loads((tmp_path / "a.json").read_text("utf-8")) == {"file": "b\udcff ä"}


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a device of Linux")
def test_a_device_that_is_full_is_named() -> None:
    with pytest.raises(FileError, match=r"^/dev/full cannot be written: no space left on device\.$"):
        write_text("/dev/full", "x")


def test_two_writers_of_one_archive_do_not_meet(tmp_path: Path) -> None:
    file, errors = tmp_path / "Some.fmu", []
    parts = [{f"{k}.bin": bytes([k]) * 300_000, "modelDescription.xml": b"%d" % k} for k in range(2)]

    def write(k: int, start: threading.Barrier) -> None:
        try:
            start.wait()
            write_zip(parts[k], file)
        except Exception as error:
            errors.append(error)

    for _ in range(10):
        start = threading.Barrier(2)
        writers = [threading.Thread(target=write, args=(k, start)) for k in range(2)]
        for writer in writers:
            writer.start()
        for writer in writers:
            writer.join()
        assert not errors
        with zipfile.ZipFile(file) as archive:
            assert archive.testzip() is None
            k = int(archive.read("modelDescription.xml"))
            assert archive.read(f"{k}.bin") == parts[k][f"{k}.bin"]
        assert names(tmp_path) == ["Some.fmu"]


def test_a_folder_is_there_whole_or_not_at_all(tmp_path):
    target = tmp_path / "new" / "folder"

    def fill(text):
        with atomic_folder(target) as temporary:
            (temporary / "a").write_text(text)

    with pytest.raises(TypeError):
        fill(1)
    assert list(target.parent.iterdir()) == []
    fill("1")
    assert [file.name for file in target.iterdir()] == ["a"]


def test_of_two_programs_that_make_a_folder_the_first_wins(tmp_path):
    with atomic_folder(tmp_path / "a") as temporary:
        (temporary / "b").write_text("second")
        (tmp_path / "a").mkdir()
        (tmp_path / "a" / "b").write_text("first")
    assert (tmp_path / "a" / "b").read_text() == "first"
    assert [place.name for place in tmp_path.iterdir()] == ["a"]
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="file cannot be written: "), atomic_folder(tmp_path / "file") as temporary:
        (temporary / "b").write_text("")


def test_a_lock_goes_with_the_process_that_holds_it(tmp_path):
    text = f"from ali3.locks import locked\nwith locked({str(tmp_path)!r}):\n    print('held', flush=True); input()"
    pipe = subprocess.PIPE
    with subprocess.Popen([sys.executable, "-c", text], stdin=pipe, stdout=pipe, text=True) as one:
        assert one.stdout.readline() == "held\n"
        with pytest.raises(FileError, match="Somebody works there"), locked(tmp_path, "Somebody works there."):
            pass
        one.kill()
    with locked(tmp_path, "Somebody works there."):
        pass
