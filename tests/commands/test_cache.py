"""The cache of the user: where the system keeps caches, in a folder that the user sets, or in a temporary folder."""

import os
import shutil
import time
from pathlib import Path

import platformdirs
import pytest

from ali3.cache import cache_folder
from ali3.errors import FileError
from ali3.folders import forget_oldest
from mbs.kernel import build


def test_the_user_may_name_it(tmp_path, monkeypatch):
    monkeypatch.setenv("ALI3_CACHE", str(tmp_path / "mine"))
    assert cache_folder("worlds", "named") == tmp_path / "mine" / "worlds" / "named"
    assert cache_folder("worlds", "named").is_dir()


def test_one_that_cannot_be_written_is_refused_if_it_was_named(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("ALI3_CACHE", str(tmp_path / "file"))
    with pytest.raises(FileError, match="ALI3_CACHE is '.*file', which cannot be written: "):
        cache_folder("worlds")


def test_without_a_home_it_is_a_folder_that_goes(tmp_path, monkeypatch):
    monkeypatch.delenv("ALI3_CACHE", raising=False)
    (tmp_path / "file").write_text("")
    monkeypatch.setattr(platformdirs, "user_cache_path", lambda *_, **__: tmp_path / "file" / "ali3")
    folder = cache_folder("worlds")
    assert folder.is_dir()
    assert tmp_path not in folder.parents
    assert cache_folder("worlds") == folder


def test_the_folders_that_were_used_last_stay(tmp_path):
    for k in range(4):
        (tmp_path / str(k)).mkdir()
        os.utime(tmp_path / str(k), (k, k))
    (tmp_path / ".ali3-0").mkdir()  # of another program, now
    forget_oldest(tmp_path, 2)
    assert sorted(place.name for place in tmp_path.iterdir()) == [".ali3-0", "2", "3"]


def test_folders_in_use_stay_however_many_they_are(tmp_path):
    now = time.time()
    for k, age in enumerate((3e3, 5e3, 7e3, 9e3)):
        (tmp_path / str(k)).mkdir()
        os.utime(tmp_path / str(k), (now - age, now - age))
    forget_oldest(tmp_path, 1, in_use=6e3)
    assert sorted(place.name for place in tmp_path.iterdir()) == ["0", "1"]


def test_a_folder_that_another_program_removes_meanwhile_is_left_out(tmp_path, monkeypatch):
    for k in range(3):
        (tmp_path / str(k)).mkdir()
        os.utime(tmp_path / str(k), (k, k))
    is_dir = Path.is_dir

    def removed_then(path):
        result = is_dir(path)
        if path.name == "1":
            path.rmdir()
        return result

    monkeypatch.setattr(Path, "is_dir", removed_then)
    forget_oldest(tmp_path, 1)
    monkeypatch.undo()
    assert sorted(place.name for place in tmp_path.iterdir()) == ["2"]


def test_a_kernel_is_compiled_once_for_all_folders_with_the_same_sources(tmp_path, monkeypatch):
    """The compiler is not called again for a copy; it is where a header, an option or the platform differs."""
    compiled = []

    def compile_c(files, target, path, **_):
        compiled.append(target)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"library {len(compiled)}")

    monkeypatch.setattr(build, "cache_directory", lambda: tmp_path / "cache")
    monkeypatch.setattr(build, "compile_c", compile_c)
    folders = [tmp_path / "a", tmp_path / "b"]
    results = []

    def make(target="x86_64-linux-gnu.2.17"):
        results.append(build.compile_library(target).read_text())

    for folder in folders:
        for room in ("src", "include"):
            shutil.copytree(build.HERE / room, folder / room)
    for folder in folders:
        monkeypatch.setattr(build, "HERE", folder)
        make()
    assert results == ["library 1"] * 2
    with (folders[1] / "src" / "system.h").open("a") as header:
        header.write("\n")
    make()
    make("aarch64-linux-gnu.2.17")
    monkeypatch.setattr(build, "FLAGS", [*build.FLAGS, "-g"])
    make()
    assert results[2:] == ["library 2", "library 3", "library 4"]
    monkeypatch.setattr(build, "HERE", folders[0])
    monkeypatch.setattr(build, "FLAGS", build.FLAGS[:-1])
    make()
    assert results[-1] == "library 1"
    assert len(compiled) == 4


def test_all_installations_of_the_compiler_read_the_same_headers(tmp_path, monkeypatch):
    """Files of another inode are noted again in the cache, for which a compiler waits until no other one runs."""
    monkeypatch.setattr(build, "cache_directory", lambda: tmp_path / "cache")
    headers = []
    for name in ("a", "b"):
        (tmp_path / name / "lib" / "include").mkdir(parents=True)
        (tmp_path / name / "lib" / "include" / "float.h").write_text(name)
        monkeypatch.setattr(build, "compiler", lambda name=name: str(tmp_path / name / "zig"))
        headers.append(Path(build.compiler_environment()["ZIG_LIB_DIR"], "include", "float.h"))
    assert headers[0].samefile(headers[1])
    shutil.rmtree(tmp_path / "a")
    assert headers[1].read_text() == "a"
    (tmp_path / "full").write_text("")
    monkeypatch.setattr(build, "cache_directory", lambda: tmp_path / "full")
    assert build.compiler_environment()["ZIG_LIB_DIR"] == str(tmp_path / "b" / "lib")
