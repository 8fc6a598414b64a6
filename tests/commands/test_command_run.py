"""The end of a command: one sentence for an error, one line for Ctrl-C, an exit code."""

import os
import shlex
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from ali3 import processes
from ali3.command_run import run_command
from ali3.errors import FileError, UserError
from ali3.message_text import one_line, shortened
from ali3.processes import module_command
from mbs.kernel import build


def raiser(error: BaseException) -> int:
    raise error


@pytest.mark.parametrize(
    ("error", "status", "message"),
    [
        (UserError("The step is 0 s."), 2, "error: The step is 0 s.\n"),
        (ValueError("No such scene."), 2, "error: No such scene.\n"),
        (OSError(28, "No space left on device", "a.csv"), 2, "error: a.csv: no space left on device.\n"),
        (ModuleNotFoundError("No module named 'fmpy.x'", name="fmpy.x"), 2, 'python -m pip install "ali3[hosts]"\n'),
        (
            UnicodeEncodeError("utf-8", "out/b\udcff.csv", 5, 6, "surrogates not allowed"),
            2,
            "error: A name has bytes that are not UTF-8, 'out/b\\udcff.csv'; give the file or folder another name.\n",
        ),
        (KeyboardInterrupt(), 130, "stopped by Ctrl-C\n"),
        (MemoryError(), 2, "raise the limit (ulimit -v).\n"),
        (RuntimeError("can't start new thread"), 2, "raise the limit (ulimit -u).\n"),
        (OSError("sources.so: failed to map segment from shared object"), 2, "from shared object\n"),
    ],
)
def test_errors_are_one_line(error, status, message, capsys):
    assert run_command(lambda: raiser(error), (ValueError,)) == status
    captured = capsys.readouterr()
    assert captured.err.endswith(message)
    assert captured.err.count("\n") == 1
    assert captured.out == ""


@pytest.mark.parametrize(
    "error",
    [
        RuntimeError("can't start new thread"),
        OSError("sources.so: failed to map segment from shared object"),
        ImportError("etree.so: failed to map segment from shared object"),
    ],
)
def test_missing_memory_is_named_as_the_cause(error, capsys, monkeypatch):
    monkeypatch.setattr(processes, "_SPARE_MEMORY", 1 << 60)
    assert run_command(lambda: raiser(error)) == 2
    assert capsys.readouterr().err.endswith("raise the limit (ulimit -v).\n")


@pytest.mark.skipif(sys.platform == "win32", reason="a shell of POSIX closes them")
@pytest.mark.parametrize("closed", ["<&-", ">&-", "2>&-", "<&- >&- 2>&-"])
def test_streams_that_the_shell_has_closed_are_nothing(closed):
    """Their numbers are no longer free for pipes, and what is printed there is gone."""
    work = (
        "import os, sys; print('out'); print('error', file=sys.stderr); "
        "sys.exit(0 if min(os.pipe()) > 2 and not sys.stdin.read() else 7)"
    )
    code = f"from ali3.command_run import run_command; run_command(lambda: exec({work!r}) or 0)"
    command = f"{shlex.quote(sys.executable)} -c {shlex.quote(code)} {closed}"
    done = subprocess.run(["sh", "-c", command], cwd=Path(__file__).parents[2], stdin=subprocess.DEVNULL, timeout=60)
    assert done.returncode == 0


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a device of Linux")
def test_an_output_that_is_full_is_one_sentence():
    code = "from ali3.command_run import run_command; raise SystemExit(run_command(lambda: print('x') or 0))"
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-c", code], cwd=Path(__file__).parents[2], stdout=full, stderr=subprocess.PIPE, text=True
        )
    assert (done.returncode, done.stderr) == (2, "error: There is no room for the output: no space left on device.\n")


def test_a_current_folder_that_was_deleted_is_the_cause(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "gone").mkdir()
    os.chdir("gone")
    try:
        (tmp_path / "gone").rmdir()
    except OSError:
        pytest.skip("the folder of a process cannot be deleted here")
    assert run_command(lambda: len(str(Path.cwd()))) == 2
    assert capsys.readouterr().err == "error: The current folder has been deleted; change to another one.\n"


@pytest.mark.parametrize("encoding", ["ascii", "cp1252", "utf-8", "ascii:surrogateescape"])  # the last for LANG=C
def test_what_the_encoding_of_the_output_lacks_ends_no_command(encoding):
    code = "from ali3.command_run import run_command; run_command(lambda: print('a \\u2212\\udcff') or 0)"
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=Path(__file__).parents[2],
        env={**os.environ, "PYTHONIOENCODING": encoding},
        capture_output=True,
    )
    minus = "\u2212".encode(encoding.partition(":")[0], "backslashreplace")
    assert (done.returncode, done.stderr, done.stdout.strip()) == (0, b"", b"a " + minus + b"\\udcff")


@pytest.mark.parametrize(
    "error",
    [
        UserError(f"'{'x' * 100_000}' is not a number."),
        UserError(f"The value is {'1 2 ' * 50_000}."),
        OSError(36, "File name too long", "a/" * 50_000),
    ],
)
def test_no_value_makes_a_sentence_endless(error, capsys):
    assert run_command(lambda: raiser(error)) == 2
    errors = capsys.readouterr().err
    assert len(errors) < 2200
    assert errors.endswith((" number.\n", "1 2 .\n", "file name too long.\n"))


def test_a_usual_sentence_is_reported_whole():
    sentence = f"/{'folder/' * 25}car.fmu is not an FMU; its inputs are: {', '.join(f'input_{k}' for k in range(99))}."
    assert shortened(sentence) == sentence


def test_a_word_is_shortened_above_its_limit():
    assert shortened("x" * 240) == "x" * 240
    assert shortened("x" * 241) == f"{'x' * 100}...{'x' * 60}"


def test_one_line_is_short_also_with_control_characters():
    zeros = r"\x00" * 50
    assert one_line("\x00" * 10_000) == f"{zeros} ... {zeros}"
    assert one_line("a\nb") == r"a\nb"


def test_names_of_files_send_no_control_characters_to_a_terminal(capsys):
    assert run_command(lambda: raiser(UserError("m.toml has '\x1b[2J\x9b' in\nits second line."))) == 2
    assert capsys.readouterr().err == "error: m.toml has '\\x1b[2J\\x9b' in\nits second line.\n"


@pytest.mark.slow
def test_errors_of_ours_keep_their_traceback():
    for error in (ZeroDivisionError(), ModuleNotFoundError("No module named 'x'", name="x")):
        with pytest.raises(type(error)):
            run_command(lambda error=error: raiser(error))


def test_a_module_starts_with_the_same_search_path(tmp_path):
    (tmp_path / "json.py").write_text("raise SystemExit('the file of the user')\n")
    command = module_command("json.tool", "--help")
    assert subprocess.run(command, cwd=tmp_path, capture_output=True, check=False).returncode == 0


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT for one process there")
def test_ctrl_c_during_a_drive_is_one_line_and_leaves_nothing(swing_fmu, tmp_path):
    (tmp_path / "m.csv").write_text('"time","torque"\n0,0\n100000,1\n')
    (tmp_path / "temporary").mkdir()
    process = subprocess.Popen(
        [sys.executable, "-m", "ali3", "run", str(swing_fmu), "-m", "m.csv"],
        cwd=tmp_path,
        env=os.environ | {"TMPDIR": str(tmp_path / "temporary")},
        stderr=subprocess.PIPE,
        text=True,
        # a shell that started these tests in the background lets all their children ignore it
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    output = ""
    while "%" not in output:  # the bar: the drive has begun
        letter = process.stderr.read(1)
        assert letter, output
        output += letter
    process.send_signal(signal.SIGINT)
    rest = process.communicate(timeout=60)[1]
    assert process.returncode == 130
    assert rest.splitlines()[-1] == "stopped by Ctrl-C"
    assert "Traceback" not in rest
    assert list((tmp_path / "temporary").iterdir()) == []
    assert not (tmp_path / "out").exists()


def test_without_a_home_the_compiler_leaves_nothing_in_the_temporary_folder(tmp_path):
    (tmp_path / "file").write_text("")
    text = (
        "from mbs.kernel.build import cache_directory as where; (where() / 'big').write_text('x');"
        "print(where() == where(), where())"
    )
    environment = {k: v for k, v in os.environ.items() if k != "ZIG_GLOBAL_CACHE_DIR"}
    environment |= {"HOME": str(tmp_path / "file" / "none"), "USERPROFILE": str(tmp_path / "file" / "none")}
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    environment |= {"TMPDIR": str(temporary), "TEMP": str(temporary), "TMP": str(temporary)}
    done = subprocess.run([sys.executable, "-c", text], env=environment, check=True, capture_output=True, text=True)
    same, folder = done.stdout.split()
    assert same == "True"
    assert Path(folder).parent == temporary
    assert list(temporary.iterdir()) == []


def test_a_cache_that_cannot_be_written_is_named(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("ZIG_GLOBAL_CACHE_DIR", str(tmp_path / "file"))
    build.cache_directory.cache_clear()
    with pytest.raises(FileError, match=r"ZIG_GLOBAL_CACHE_DIR is '.*file', which cannot be written: "):
        build.cache_directory()
    build.cache_directory.cache_clear()
