"""The commands and snippets of docs/your_own_car.md run and print what it says."""

import io
import re
import tomllib
from contextlib import chdir, redirect_stderr, redirect_stdout

import fmpy
import pytest

from ali3.command import main
from tests.docs.test_documents import ROOT, run

pytestmark = pytest.mark.slow

PAGE = (ROOT / "docs" / "your_own_car.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"^    ali3 (.*)$", PAGE, re.MULTILINE)


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)


def ali3(line, folder, status=0):
    """Run a command line of the page; the process that a user starts for it is tested with the commands."""
    with chdir(folder), redirect_stdout(io.StringIO()) as out, redirect_stderr(io.StringIO()) as error:
        code = main(line.split())
    assert code == status, error.getvalue()
    return out.getvalue() + error.getvalue()


def edit(file, changes, table=""):
    """Write values into a car file as a user does in an editor."""
    for key, value in changes.items():
        if isinstance(value, dict):
            edit(file, value, f"{table}.{key}" if table else key)
            continue
        text = file.read_text(encoding="utf-8")
        start = text.index(f"\n[{table}]") if table else 0
        literal = f'"{value}"' if isinstance(value, str) else repr(value)
        changed, count = re.subn(rf"(?m)^{key} = [^#\n]*", f"{key} = {literal} ", text[start:], count=1)
        assert count == 1, (table, key)
        file.write_text(text[:start] + changed, encoding="utf-8")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder in which the page has been followed up to the check."""
    place = tmp_path_factory.mktemp("own_car")
    assert "prototype" in ali3(COMMANDS[0], place)
    assert "my_car/car.toml" in ali3(COMMANDS[1], place).replace("\\", "/")
    (snippet,) = blocks("toml")
    edit(place / "my_car" / "car.toml", tomllib.loads(snippet))
    assert (place / "my_car" / "car.toml").read_text(encoding="utf-8").startswith("#:schema car.schema.json\n")
    assert (place / "my_car" / "car.schema.json").is_file()
    return place


def test_the_page_shows_the_commands_in_order():
    assert [line.split()[0] for line in COMMANDS] == ["car", "car", "car", "build", "run", "run"]


def test_the_check_prints_the_output_of_the_page(folder):
    printed = ali3(COMMANDS[2], folder)
    for line in blocks("text")[0].splitlines():
        assert line in printed
    assert "warning" not in printed
    assert "front.damper.damping" in ali3(f"{COMMANDS[2]} --show-parameters", folder)


@pytest.mark.parametrize(
    ("number", "before", "after"),
    [
        (0, "stiffness = 14000.0", "stiffness = 14.0"),
        (1, "[front.spring]\nstiffness", "[front.spring]\nstifness"),
        (2, "mass = 597.0", "mass = 650.0"),
    ],
)
def test_the_errors_of_the_page(folder, number, before, after):
    file = folder / "my_car" / "car.toml"
    kept = file.read_text(encoding="utf-8")
    assert before in kept
    try:
        file.write_text(kept.replace(before, after, 1), encoding="utf-8")
        assert ali3(COMMANDS[2], folder, 2).strip() == blocks("text")[1].splitlines()[number]
    finally:
        file.write_text(kept, encoding="utf-8")


def test_the_warning_of_the_page(folder):
    file = folder / "my_car" / "car.toml"
    kept = file.read_text(encoding="utf-8")
    try:
        file.write_text(kept.replace("stiffness = 14000.0", "stiffness = 10000.0", 1), encoding="utf-8")
        assert blocks("text")[2].strip() in ali3(COMMANDS[2], folder)
    finally:
        file.write_text(kept, encoding="utf-8")


def test_the_snippet_in_python(folder):
    (code,) = blocks("python")
    printed = run(code, folder)
    assert re.search(r"\d+ numbers can be tuned, front\.damper\.damping = 1200", printed)
    assert 3.0 < float(re.search(r"after 2 s (\d+) m/s", printed)[1]) < 15.0


def test_build_drive_and_tune(folder):
    assert "dist/MyCar.fmu" in ali3(COMMANDS[3], folder).replace("\\", "/")
    assert (folder / "dist" / "MyCar.ssv").is_file()
    names = {v.name: v for v in fmpy.read_model_description(str(folder / "dist" / "MyCar.fmu")).modelVariables}
    assert float(names["front.spring.stiffness"].start) == 14000.0
    for line in COMMANDS[4:]:
        assert "failed steps               0 of" in ali3(line, folder)
    assert any((folder / "out").glob("my_car_step_steer*"))
