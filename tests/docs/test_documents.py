"""Examples in the documents run and print what the text says; names in them exist."""

import ast
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import mbs
from benchmarks.car.variable_tables import blocks, tables
from benchmarks.references.cases import CASES
from fmu_src.build.scene_registry import load_scene
from hosts.driving.manoeuvres import manoeuvre_names
from mbs.kernel.header.limits import SYSTEM_VERSION
from mbs.settings.settings import METHODS

ROOT = Path(__file__).parents[2]
PAGES = ("README.md", "CONTRIBUTING.md", "mbs/kernel/src/methods/README.md")
DOCUMENTS = [*(ROOT / page for page in PAGES), *sorted((ROOT / "docs").rglob("*.md"))]
TEXTS = {file: file.read_text(encoding="utf-8") for file in DOCUMENTS}
README = (ROOT / "README.md").read_text(encoding="utf-8")
THEORY = (ROOT / "docs" / "theory.md").read_text(encoding="utf-8")
FORCE_LAWS = (ROOT / "docs" / "force_laws.md").read_text(encoding="utf-8")
FILE = r"[\w./]+\.(?:c|h|py|md|cff)"


def snippets(text):
    return re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


def run(code, folder):
    """Standard output of a program run as a user runs it, warnings as errors."""
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code],
        capture_output=True,
        text=True,
        check=False,
        cwd=folder,
        env=os.environ | {"PYTHONPATH": str(ROOT), "PYTHONIOENCODING": "utf-8", "MPLBACKEND": "Agg"},
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def defines(file, name):
    """Whether a C or Python file defines a function, class or macro of that name."""
    text = (ROOT / file).read_text(encoding="utf-8")
    bare = name.removeprefix("ali3_")
    in_c = rf"^(?:#define {name}\b|\w[^;=\n]*\b{name}\(|ALI3_BY_PROCESSOR\([^,]*, \w+, {bare},)"
    pattern = rf"^\s*(?:def|class) {name}\b" if file.endswith(".py") else in_c
    return re.search(pattern, text, re.MULTILINE) is not None


@pytest.mark.slow
def test_stepping_page_runs_and_both_hosts_print_its_numbers(prototype_fmu, tmp_path):
    page = (ROOT / "docs" / "stepping.md").read_text(encoding="utf-8")
    thing, _, whole, fmu, _, model = snippets(page)
    line = re.search(r"^    (after .*)$", page, re.MULTILINE)[1]
    (tmp_path / "dist").mkdir()
    shutil.copy(prototype_fmu, tmp_path / "dist")
    x, y = map(float, re.search(r"x = ([\d.-]+) m, y = ([\d.-]+) m", run(whole, tmp_path)).groups())
    assert x > 10.0
    assert y > 10.0  # steering is positive to the left
    named = thing.replace('"prototype"', '"dist/PrototypeCar.fmu"').replace("car.close()", "")
    ways = (
        f"{fmu}\nprint([speed, yaw_rate])",
        f"{model}\nprint([now['speed'], now['chassis.wz']])",
        f"{named}\nprint([float(speed), float(yaw_rate)])",
    )
    printed = run(f"for code in {ways!r}:\n    exec(code, {{}})", tmp_path).splitlines()
    by_fmu, by_model, by_name = printed[:2], printed[2:4], printed[4:]
    assert by_fmu[0] == line
    assert by_fmu[0] == by_model[0]
    # on a busy machine the model has differed by 3e-14 in a few runs of all tests, never alone; why is not known
    assert ast.literal_eval(by_model[1]) == pytest.approx(ast.literal_eval(by_fmu[1]), rel=1e-11)
    assert by_name == by_fmu


@pytest.mark.slow
def test_stepping_page_sets_derivatives_and_names_the_failure_of_fmpy(prototype_fmu, tmp_path):
    page = (ROOT / "docs" / "stepping.md").read_text(encoding="utf-8")
    code = next(s for s in snippets(page) if "setRealInputDerivatives" in s)
    (tmp_path / "dist").mkdir()
    shutil.copy(prototype_fmu, tmp_path / "dist")
    printed = run(code, tmp_path).splitlines()
    assert "".join(f"    {line}\n" for line in printed) in page
    held, followed = (float(re.search(r": (\S+) mm", line)[1]) for line in printed)
    assert followed < 0.05 * held
    table = (
        "import fmpy, numpy\ntable = numpy.zeros(3, [('time', float), ('steering', float)])\ntable['time'] = 0, 1, 2\n"
    )
    call = "fmpy.simulate_fmu('dist/PrototypeCar.fmu', stop_time=1.0, input=table, set_input_derivatives=True)"
    output = run(f"{table}try:\n    {call}\nexcept ValueError as error:\n    print(error)", tmp_path)
    assert output.strip().endswith("Can only assign sequence of same size")


@pytest.mark.slow
def test_stepping_page_makes_several_environments(prototype_fmu, tmp_path):
    several = snippets((ROOT / "docs" / "stepping.md").read_text(encoding="utf-8"))[1]
    of_rigid_car = several.replace('-v0", 8)', f'-v0", 8, car={str(prototype_fmu)!r})')
    assert of_rigid_car != several
    assert run(f"{of_rigid_car}\nprint(observations.shape)", tmp_path).startswith("(8, ")


@pytest.mark.slow
def test_readme_models_a_pendulum(tmp_path):
    code = next(s for s in snippets(README) if "import mbs" in s)
    printed = run(code, tmp_path).strip()
    output = re.search(r"It prints `(.*?)`", README)[1]
    assert printed.split("energy")[0] == output.split("energy")[0]
    assert float(re.search(r"kept to (\S+) J", printed)[1]) < 1e-3


@pytest.mark.slow
def test_modelling_page_runs(tmp_path):
    code = "\n".join(snippets((ROOT / "docs" / "modelling.md").read_text(encoding="utf-8")))
    printed = run(code, tmp_path)
    assert "degrees of freedom           1" in printed
    assert "Trajectory(2001 samples" in printed
    assert "the crank has turned 758.63 rad" in printed
    assert "after 1 s 100 and -33 rad/s" in printed  # 2 N m on 0.01 + 0.09/9 kg m2
    assert "friction 0.5: slides 0.41 m" in printed  # v^2/(2 mu g)
    assert "friction 0.1: slides 2.04 m" in printed


@pytest.mark.slow
@pytest.mark.parametrize("page", ["speed", "roads"])
def test_examples_of_a_page_run(page, tmp_path):
    for code in snippets((ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")):
        assert run(code, tmp_path).strip()


@pytest.mark.slow
def test_the_log_of_the_page_on_measurements_has_the_columns_of_its_alias_file(prototype_fmu, tmp_path):
    (code,) = snippets((ROOT / "docs" / "compare.md").read_text(encoding="utf-8"))
    (tmp_path / "dist").mkdir()
    shutil.copy(prototype_fmu, tmp_path / "dist")
    run(code, tmp_path)
    columns = (tmp_path / "drive.csv").read_text(encoding="utf-8").partition("\n")[0].split(";")
    aliases = tomllib.loads((tmp_path / "drive.toml").read_text(encoding="utf-8"))
    assert {aliases["time"]["name"], *(entry["name"] for entry in aliases["signals"].values())} == set(columns)


def test_pages_list_the_manoeuvres_and_the_scene_of_ones_own():
    driving = (ROOT / "docs" / "fmu.md").read_text(encoding="utf-8").partition("## Driving it")[2]
    for name in manoeuvre_names():
        assert f"`{name}`" in driving
    examples = (ROOT / "docs" / "examples.md").read_text(encoding="utf-8")
    scene = re.search(r"--scene (\S+\.py:\w+)", examples)[1]
    lines = (ROOT / scene.split(":")[0]).read_text(encoding="utf-8").splitlines()
    assert f"in {len(lines)} lines" in examples
    assert load_scene(str(ROOT / scene))[0] == scene.split(":")[1]


@pytest.mark.slow
def test_tables_of_variables_are_those_of_the_cars():
    result = tables()
    actual = blocks(result)
    text = (ROOT / "docs" / "variables.md").read_text(encoding="utf-8")
    assert re.findall(r"<!-- made with the site: (.+) -->", text) == list(actual)
    page = "\n".join(actual.values())
    # nothing is missing and nothing is there that no car has
    names = {v.name for variables in result.values() for v in variables}
    shown = set(re.findall(r"^\| ((?:`[^`]+`[,. ]*)+)", page, re.MULTILINE))
    listed = {name for cell in shown for name in re.findall(r"`([^`]+)`", cell)}
    four = {re.sub(r"_FL\b", f"_{wheel}", name) for name in listed for wheel in ("FL", "FR", "RL", "RR")}
    assert listed <= names == listed | (four & names)


def test_links_and_named_files_exist():
    missing = []
    for file, text in TEXTS.items():
        links = [file.parent / target for target in re.findall(r"\]\(([^)#:]+)\)", text)]
        named = re.findall(rf"`((?:mbs|fmu_src|hosts|benchmarks|tests|docs|examples)/{FILE})`", text)
        missing += [f"{file.name}: {target}" for target in links if not target.exists()]
        missing += [f"{file.name}: {name}" for name in named if not (ROOT / name).is_file()]
    assert not missing, "\n".join(missing)


def test_lines_have_at_most_120_characters():
    long = []
    for file, text in TEXTS.items():
        lines = re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL).splitlines()
        long += [f"{file.name}: {line}" for line in lines if len(line) > 120 and not line.startswith(("|", "    "))]
    assert not long, "\n".join(long)


def test_decisions_are_listed_by_their_headings():
    folder = ROOT / "docs" / "decisions"
    files = sorted(folder.glob("[0-9]*.md"))
    rows = [
        f"| [{int(file.name[:4])}]({file.name}) | {TEXTS[file].splitlines()[0].partition('. ')[2]} |" for file in files
    ]
    listed = TEXTS[folder / "README.md"].splitlines()
    assert [line for line in listed if line.startswith("| [")] == rows
    assert [TEXTS[file].split(". ", 1)[0] for file in files] == [f"# {int(file.name[:4])}" for file in files]


def test_linked_headings_exist():
    missing = []
    for file, text in TEXTS.items():
        for target, anchor in re.findall(r"\]\(([^)#:]*)#([^)]+)\)", text):
            page = (file.parent / target).read_text(encoding="utf-8") if target else text
            headings = re.findall(r"^#+ (.*)$", page, re.MULTILINE)
            if anchor not in {re.sub(r"[^\w -]", "", h.lower()).replace(" ", "-") for h in headings}:
                missing.append(f"{file.name}: {target}#{anchor}")
    assert not missing, "\n".join(missing)


def test_the_pages_name_every_method_and_the_readme_counts_methods_and_scenes():
    stability = (ROOT / "docs" / "stability.md").read_text(encoding="utf-8")
    for text, heading in ((stability, "## Where each method must not be used"), (THEORY, "## Other methods")):
        section = text.partition(heading)[2].partition("\n## ")[0]
        assert re.findall(r"^\| `(\w+)`", section, re.MULTILINE) == list(METHODS)
    message = {9: "nine", 13: "thirteen"}
    assert f"the {message[len(METHODS)]} methods" in README
    assert f"has {message[len(CASES)]} scenes" in README


def test_theory_names_functions_that_exist():
    listed = [
        (file, names)
        for file, names in re.findall(rf"`({FILE})`(?: \||,)((?:[,\s]*`\w+`)+)", THEORY + FORCE_LAWS)
        if file.endswith((".c", ".h", ".py"))
    ]
    results = [(file, name) for file, names in listed for name in re.findall(r"`(\w+)`", names)]
    assert len(results) > 40
    missing = [f"{file}: {name}" for file, name in results if not defines(file, name)]
    assert not missing


@pytest.mark.parametrize("file", [ROOT / page for page in PAGES[1:]], ids=lambda p: p.name)
def test_names_of_the_kernel_in_the_guides_exist(file):
    sources = (ROOT / "mbs" / "kernel").rglob("*.[ch]")
    message = set(re.findall(r"\w+", "\n".join(source.read_text(encoding="utf-8") for source in sources)))
    code = re.findall(r"`([^`]+)`", file.read_text(encoding="utf-8"))
    named = {word for span in code for word in re.findall(r"\b(?:ali3_\w*[a-z0-9]\b(?!<)|ALI3_\w+|(?<=->)\w+)", span)}
    assert len(named) >= 4
    assert named - message == set()


def test_theory_has_all_equations_from_1_to_25():
    table = THEORY.partition("## Equation of the paper")[2].partition("\n## ")[0]
    first_cells = " ".join(line.split("|")[1] for line in table.splitlines() if line.startswith("| ("))
    assert {int(n) for n in re.findall(r"\((\d+)\)", first_cells)} == set(range(1, 26))


def test_the_page_of_the_system_file_has_its_version():
    page = TEXTS[ROOT / "docs" / "system_file.md"]
    assert re.findall(r"^\| version = (\d+) \|", page, re.MULTILINE) == [str(SYSTEM_VERSION)]


def test_the_reference_has_every_public_name():
    pages = "\n".join(f.read_text(encoding="utf-8") for f in (ROOT / "docs" / "reference").glob("*.rst"))
    named = set(re.findall(r"^\.\. auto\w+:: mbs\.(\w+)$", pages, re.MULTILINE))
    assert set(mbs.__all__) - named == set()
    for module in ("elements", "flexible"):
        assert f".. automodule:: mbs.{module}\n   :imported-members:" in pages
