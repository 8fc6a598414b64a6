"""The console command: one table, fast help, command names in messages as typed, no import of files of the user."""

import argparse
import importlib
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path

import pytest

import ali3
from ali3 import processes
from ali3.command import main
from ali3.commands import COMMANDS, Command
from ali3.decimal_number import number
from ali3.options import SHARED, Parser, assignment, count, name_and_text

ROOT = Path(ali3.__file__).parents[1]
# What an installation writes into the folder of programs.
SCRIPT = "import sys\nfrom ali3.__main__ import main\nif __name__ == '__main__':\n    sys.exit(main())\n"
# Names of ours, of what we import, and of the standard library.
NAMES = (
    *("ali3", "mbs", "fmu_src", "hosts", "benchmarks", "build_fmu", "numpy", "scipy", "fmpy", "matplotlib", "tqdm"),
    *("ziglang", "pythonfmu", "argparse", "csv", "configparser", "json", "random", "subprocess", "tempfile", "types"),
    *("typing", "zipfile", "ctypes", "dataclasses", "signal", "threading", "platform", "queue", "test", "run", "check"),
)
HEAVY = ("numpy", "scipy", "fmpy", "matplotlib", "lxml", "pydantic", "tqdm", "pandas", "distributed")
OURS = ("mbs", "fmu_src", "hosts", "viewer")
HEAVIER = ("simulator", "catalogue")
"""Commands whose modules load for more than a second."""
MOST_MODULES = 40
"""Of ours, which the help of a command may load."""
MOST_OPTIONS = 176
"""Of all commands together; there were 153 before they were ten."""
CODE = ("ali3", "mbs", "fmu_src", "hosts", "viewer/page/src", "examples", "benchmarks", "docs/_site")


class Parsed(Exception):  # noqa: N818  # in place of the work of a command
    """The parser of a command."""


def parser_of(command: Command) -> argparse.ArgumentParser:
    def stop(parser: argparse.ArgumentParser, _: Sequence[str]) -> None:
        raise Parsed(parser)

    module = importlib.import_module(command.module)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(argparse.ArgumentParser, "parse_args", stop)
        with pytest.raises(Parsed) as raised:
            module.main([], f"ali3 {command.name}")
    return raised.value.args[0]


PARSERS = {command.name: parser_of(command) for command in COMMANDS}


def options_of(name: str) -> dict[str, argparse.Action]:
    """The options of a command by each of their names, without those that the help does not show."""
    actions = PARSERS[name]._actions
    return {name: action for action in actions if action.help != argparse.SUPPRESS for name in action.option_strings}


def names_exist(message: Sequence[str]) -> str:
    """What is wrong with the command and the options of a line that may have placeholders."""
    if message[0] not in PARSERS:
        return "no command"
    known = {*options_of(message[0]), "--inside"}
    unknown = [w for w in message if w.startswith("--") and w.partition("=")[0] not in known]
    return f"no option {unknown[0]}" if unknown else ""


def parses(message: Sequence[str], capsys: pytest.CaptureFixture[str]) -> str:
    """What is wrong with a line as a user types it."""
    try:
        PARSERS[message[0]].parse_args(message[1:])
    except KeyError:
        return "no command"
    except SystemExit as end:
        errors = capsys.readouterr().err.strip()
        return errors.splitlines()[-1] if end.code else ""
    return ""


def documents() -> Iterator[tuple[str, str]]:
    """Pages for users, each with its text; the log of changes and old decisions tell of what was."""
    for file in (*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md"), *(ROOT / "examples").glob("*.md")):
        if file.name not in ("CHANGELOG.md", "changelog.md"):
            yield file.name, file.read_text(encoding="utf-8")


def typed_lines(text: str) -> Iterator[list[str]]:
    """Lines of commands in indented or fenced blocks."""
    for line in re.findall(r"^    (.*\bali3 .*)$", text.replace("\\\n", " "), re.MULTILINE):
        for part in line.split("&&"):
            match = re.fullmatch(r"\s*(?:\$ )?(?:[\w./]*/)?ali3 ([^#]*?)\s*(?:#.*)?", part)
            if match and not re.search(r"[\[|<]|\.\.\.", match[1]):
                yield shlex.split(match[1])


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


def test_each_command_is_in_the_documents():
    page = (ROOT / "docs" / "commands.md").read_text(encoding="utf-8")
    rows = [line.split("|")[1:3] for line in page.splitlines() if line.startswith("| `ali3 ")]
    assert [name.strip(" `") for name, _ in rows] == [f"ali3 {c.name}" for c in COMMANDS]
    assert len(rows) == 10
    assert all(text.strip().startswith(c.summary) for (_, text), c in zip(rows, COMMANDS, strict=True))


def test_the_list_of_commands_imports_nothing_heavy(tmp_path):
    text = "import sys; from ali3.command import main\ntry: main(['--help'])\nfinally: print('\\n', *sys.modules)"
    done = ran(["-c", text], tmp_path)
    assert all(f"\n  {c.name} " in done.stdout for c in COMMANDS)
    assert all(c.summary in done.stdout for c in COMMANDS)
    assert not {*HEAVY, *OURS} & set(done.stdout.split("\n ")[-1].split())


@pytest.mark.parametrize("command", COMMANDS, ids=lambda c: c.name)
def test_the_help_of_a_command_imports_nothing_heavy(command, tmp_path):
    text = (
        "import sys; from ali3.command import main\n"
        f"try: main([{command.name!r}, '--help'])\nfinally: print('\\n', *sys.modules)"
    )
    done = ran(["-c", text], tmp_path)
    assert done.stdout.startswith(f"usage: ali3 {command.name} ")
    loaded = set(done.stdout.split("\n ")[-1].split())
    assert command.module in loaded
    assert not set(HEAVY) & loaded
    ours = {name for name in loaded if name.partition(".")[0] in (*OURS, "ali3")}
    assert len(ours) <= MOST_MODULES, sorted(ours)


def test_an_option_of_two_commands_is_one_option():
    results: dict[str, list[argparse.Action]] = {}
    for command in COMMANDS:
        for name, action in options_of(command.name).items():
            results.setdefault(name, []).append(action)
    shared = {name for name, actions in results.items() if len(actions) > 1 and name not in ("-h", "--help")}
    assert shared <= {name for key, option in SHARED.items() for name in (key, *option.other_names)}
    for key, option in SHARED.items():
        for action in results[key]:
            assert action.option_strings == [key, *option.other_names]
            assert action.help.startswith(option.help)
            if option.metavar:
                assert (action.metavar, action.type) == (option.metavar, option.type)
            else:
                assert action.nargs == 0
    assert sum(len(set(map(id, options_of(c.name).values()))) - 1 for c in COMMANDS) <= MOST_OPTIONS


def test_every_line_of_the_documents_is_a_command(capsys):
    lines = [(file, line) for file, text in documents() for line in typed_lines(text)]
    assert len(lines) > 50
    wrong = [f"{file}: ali3 {shlex.join(line)}: {why}" for file, line in lines if (why := parses(line, capsys))]
    assert not wrong, "\n".join(wrong)


def test_commands_that_documents_and_sentences_name_exist():
    texts = dict(documents())
    suffixes = (".py", ".js", ".toml")
    texts |= {str(f): f.read_text("utf-8") for c in CODE for f in (ROOT / c).rglob("*") if f.suffix in suffixes}
    spans = [(f, span) for f, text in texts.items() for span in re.findall(r"[`'\"]ali3 ([^`'\"]+)[`'\"]", text)]
    named = [(f, span.split()) for f, span in spans if "{" not in span]
    assert len(named) > 60
    plain = [(f, w) for f, message in named if (w := [re.sub(r"[\[\]]", "", word).split("|")[0] for word in message])]
    wrong = [f"{f}: ali3 {' '.join(w)}: {why}" for f, w in plain if w[0] != "COMMAND" and (why := names_exist(w))]
    called = [(f, name) for f, text in texts.items() for name in re.findall(r"command_name\([\"'](\w+)", text)]
    assert len(called) > 5
    wrong += [f"{f}: command_name({name})" for f, name in called if name not in PARSERS]
    assert not wrong, "\n".join(wrong)


def test_an_unknown_command_is_refused(capsys):
    assert main(["biuld"]) == 2
    assert "no command 'biuld'; did you mean 'build'?" in capsys.readouterr().err
    assert main(["zzz"]) == 2
    assert "the commands are build, car, run" in capsys.readouterr().err
    assert main([]) == 2


def test_messages_name_the_command_that_was_typed(capsys, tmp_path, monkeypatch):
    monkeypatch.setattr(processes, "_prefix", None)
    monkeypatch.chdir(tmp_path)
    assert main(["run", "dist/X.fmu"]) == 2
    assert "Build it with: ali3 build" in capsys.readouterr().err
    assert main(["run", "dist/X.fmu", "-m", "slalom"], prog="python -m ali3") == 2
    assert "Build it with: python -m ali3 build" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["compare"])
    assert "ali3 compare: error: the following arguments are required" in capsys.readouterr().err


@pytest.mark.parametrize(
    "command",
    [pytest.param(c, marks=[pytest.mark.slow] * (c.name in HEAVIER), id=c.name) for c in COMMANDS],
)
def test_what_is_long_on_a_command_line_is_not_quoted_whole(command, monkeypatch, capsys):
    """An unknown option, a file of that name, and each option that reads a number."""
    long, lines = 100_000 * "x", []
    parsers: list[Parser] = []
    parse = Parser.parse_args
    monkeypatch.setattr(Parser, "parse_args", lambda self, *a: (parsers.append(self), parse(self, *a))[1])
    with suppress(SystemExit):
        main([command.name, f"--{long}"])
    lines.append("".join(capsys.readouterr()))
    numbers = [a for a in parsers[0]._actions if a.type in (number, count, int, assignment, name_and_text)]
    for line in ([long], *([a.option_strings[0], long] for a in numbers)):
        with suppress(SystemExit):
            assert main([command.name, *line]) == 2
        lines.append("".join(capsys.readouterr()))
    assert all("error:" in line and len(line) < 5000 for line in lines)


def test_a_missing_extra_is_reported_with_the_line_that_installs_it(tmp_path):
    (tmp_path / "some.fmu").write_text("")
    text = "import sys; sys.modules['fmpy'] = None; from ali3.command import main; sys.exit(main(['run', 'some.fmu']))"
    done = ran(["-c", text], tmp_path)
    assert done.returncode == 2
    assert done.stderr == ('error: The package fmpy is not installed; run: python -m pip install "ali3[hosts]"\n')


@pytest.mark.slow
def test_files_of_the_user_cannot_break_a_command(script, crowded):
    done = ran([script, "build", "--scene", "pendulum", "--kind", "native", "--platforms", "this"], crowded)
    assert done.returncode == 0, done.stderr
    assert (crowded / "dist" / "Pendulum.fmu").is_file()
    done = ran([script, "run", "dist/Pendulum.fmu", "--stop-time", 1], crowded)
    assert done.returncode == 0, done.stderr
    assert (crowded / "out" / "pendulum.csv").is_file()
    done = ran([script, "run", "dist/Pendulum.fmu", "--stop-time", -1], crowded)
    assert done.returncode == 2
    assert "argument --stop-time: '-1' is given; it must be a positive, finite time in s" in done.stderr
    done = ran([script, "check", "dist/Pendulum.fmu", "--steps", 3], crowded)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "nothing bad found" in done.stdout
    done = ran([script, "run", "-m", "double_lane_change", "dist/Pendulum.fmu"], crowded)
    assert done.returncode == 2
    assert "The driver needs variables" in done.stderr


@pytest.mark.slow
def test_as_a_module_it_forgets_the_current_folder(crowded):
    # Python itself looks for these before it starts the module
    for name in ("ali3", "types", "typing", "test", "threading"):
        (crowded / f"{name}.py").unlink()
    done = ran(["-m", "ali3", "run", "none.fmu"], crowded)
    assert (done.returncode, done.stderr) == (2, "error: There is no file none.fmu.\n")


def test_ctrl_c_while_modules_are_imported_is_one_line(tmp_path):
    text = (
        "import sys\n"
        "class Interrupt:\n"
        "    def find_spec(self, name, *_):\n"
        "        if name == 'ali3.command_run': raise KeyboardInterrupt\n"
        "sys.meta_path.insert(0, Interrupt())\n"
    )
    done = ran(["-c", text + SCRIPT, "--help"], tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "stopped by Ctrl-C\n")


def test_an_installed_project_of_the_user_stays_in_the_search_path(tmp_path):
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


def test_the_module_itself_works_in_a_clone():
    done = ran(["-m", "ali3", "--help"], ROOT)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("usage: python -m ali3 ")
    assert ran(["build_fmu.py", "--help"], ROOT).stdout.startswith("usage: python build_fmu.py ")
