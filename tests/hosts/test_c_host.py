"""The host in C: setting variables by name, and refusals."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import fmpy
import pytest

from hosts.fmu.fmu import Fmu
from tests.fmu.native import HOST_SOURCE, compile_host, unpack

HERE = Path(__file__).parent


@pytest.fixture(scope="module")
def host(tuned: Path, tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """Its command line up to the number of steps."""
    folder = tmp_path_factory.mktemp("c_host")
    unpack(tuned, folder / "fmu")
    library = next((folder / "fmu" / "binaries" / fmpy.platform).iterdir())
    guid = fmpy.read_model_description(str(tuned)).guid
    return [str(compile_host(folder)), str(library), (folder / "fmu" / "resources").as_uri(), guid]


def run(host: list[str], *arguments: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([*host, *map(str, arguments)], capture_output=True, text=True, check=False)


def reference(fmu: Path, name: str) -> int:
    return next(int(v.valueReference) for v in fmpy.read_model_description(str(fmu)).modelVariables if v.name == name)


def test_names_and_references_set_the_same(tuned: Path, host: list[str]) -> None:
    place = reference(tuned, "bob.y")
    tail = (20, 0.01, place, place)
    values = {"spring.stiffness": "250", "spring.free_length": "0.7", "pull": "-3.5"}
    by_name = run(host, *tail, *(part for n, x in values.items() for part in ("--set", f"{n}={x}")))
    assert by_name.returncode == 0, by_name.stderr
    by_reference = run(host, *tail, *(f"{reference(tuned, n)}={x}" for n, x in values.items()))
    assert by_name.stdout == by_reference.stdout != run(host, *tail).stdout
    with Fmu(tuned) as driven:
        driven.initialise({n: float(x) for n, x in values.items()})
        for k in range(20):
            driven.step(0.01 * k, 0.01)
        assert float.fromhex(by_name.stdout.split()[-1]) == driven.getter(["bob.y"])()[0]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("abc", 0.01, 0, 0), "STEPS is 'abc'; it must be a whole number of at least 0."),
        ((10, "nan", 0, 0), "STEP is 'nan'"),
        ((10, 0.01, 3, 2), "LAST is '2'; it must be a whole number of at least 3."),
        ((10, 0.01, 0, 9999), "more than 4096 variables"),
        ((10, 0.01, 0, 0, "--set", "spring.stifness=1"), "the FMU has no variable 'spring.stifness'."),
        ((10, 0.01, 0, 0, "--set", "bob.y=1"), "'bob.y' is of the causality output"),
        ((10, 0.01, 0, 0, "--set", "pull=1,5"), "pull is '1,5'; it must be a number."),
        ((10, 0.01, 0, 0, "x=3"), "'x=3' is not of the form REFERENCE=VALUE."),
        ((10, 0.01, 0, 0, "--set", "spring.damping=1e9"), "spring.damping=1e9: status 3"),
    ],
)
def test_invalid_values_are_refused(host: list[str], arguments: tuple[object, ...], message: str) -> None:
    done = run(host, *arguments)
    assert done.returncode in (1, 4)
    assert message in done.stderr
    assert done.stdout == ""


def test_names_are_found_with_any_neighbouring_text(host: list[str], tmp_path: Path) -> None:
    """Comments, other quotation marks, entities, an attribute that holds the text of another."""
    folder = tmp_path / "fmu"
    (folder / "binaries" / "here").mkdir(parents=True)
    library = folder / "binaries" / "here" / Path(host[1]).name
    library.write_bytes(Path(host[1]).read_bytes())
    (folder / "modelDescription.xml").write_text(
        '<!-- <ScalarVariable name="a" valueReference="1" causality="output"><Real/></ScalarVariable> -->'
        "<ScalarVariable description=\"says name='a' > b\"  valueReference='2'\n name='b' causality='output'><Real/>"
        '<ScalarVariable name="a&lt;&amp;&quot;b" valueReference="3" causality="local"><Real/>'
        '<ScalarVariable name="a" valueReference="4" causality="output" variability="constant"><Real/>'
    )
    for name, message in (
        ("b", "'b' is of the causality output"),
        ('a<&"b', "is of the causality local"),
        ("a", "'a' is a constant"),
        ("c", "no variable 'c'"),
    ):
        done = run([host[0], str(library), *host[2:]], 1, 0.01, 0, 0, "--set", f"{name}=1")
        assert message in done.stderr


def test_inputs_on_lines_are_given_within_steps_of_fmi_3(scene_fmu: Callable[..., Path], tmp_path: Path) -> None:
    """The bits of the host in Python, which gives them too; held over steps of five inner steps they are others."""
    fmu = scene_fmu(f"{HERE / 'scenes.py'}:tuned", "fmi3_scalar")
    unpack(fmu, tmp_path / "fmu")
    library = next((tmp_path / "fmu" / "binaries" / fmpy.platform_tuple).iterdir())
    program = compile_host(tmp_path, source=HOST_SOURCE.with_name("host3.c"))
    token, resources = fmpy.read_model_description(str(fmu)).guid, tmp_path / "fmu" / "resources"
    pull, place, size = (reference(fmu, n) for n in ("pull", "bob.y", "step_size"))
    command = [program, library, f"{resources}/", token, 20, 0.05, place, place, f"{size}=0.01"]
    ends = {}
    for name, line in (("led", f"{pull}=-3.5+2"), ("held", f"{pull}=-3.5")):
        done = subprocess.run([*map(str, command), line], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        ends[name] = float.fromhex(done.stdout.split()[-1])
    with Fmu(fmu) as driven:
        assert driven.follows_slopes
        set_pull, lead = driven.setter(["pull"]), driven.slope_setter(["pull"])
        driven.initialise({"pull": -3.5, "step_size": 0.01})
        for k in range(20):
            set_pull([-3.5 + 2.0 * (0.05 * k)])
            lead([2.0])
            driven.step(0.05 * k, 0.05)
        assert ends["led"] == pytest.approx(driven.getter(["bob.y"])()[0], rel=1e-12)
    assert ends["held"] != pytest.approx(ends["led"], rel=1e-4)
