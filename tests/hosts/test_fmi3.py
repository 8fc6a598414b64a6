"""Hosts drive FMUs of FMI 3.0 as those of FMI 2.0: the same names, the same bits where inputs are held."""

import zipfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.model_description import read_model_description
from fmpy.util import read_csv

import mbs
from fmu_src.build.build import build_fmu
from hosts.fmu.fmu import Fmu, described, unpack
from hosts.fmu.instance import Instance
from hosts.fmu.scalars import ELEMENTS
from hosts.run.command import main
from mbs.shapes.pose_outputs import pose_outputs
from tests import kinds
from tests.fmu.scenes import crane
from tests.hosts.changed_fmu import DESCRIPTION, changed_fmu
from tests.hosts.scenes import switched
from tests.in_process import run

H = 0.01


@pytest.fixture(scope="module")
def fmu_of(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str, str], Path]:
    """The FMU of a scene and a kind, built where it is needed first."""
    folder = tmp_path_factory.mktemp("fmus")

    @cache
    def built(name: str, kind: str) -> Path:
        model = switched() if name == "switched" else crane()
        if name == "crane":
            pose_outputs(model)
        return build_fmu(mbs.compile(model), name, folder, [fmpy.platform], kind=kind)

    return built


@pytest.mark.parametrize("kind", kinds.VERSIONS)
def test_a_percent_sign_in_a_message_is_shown_as_the_fmu_means_it(kind, fmu_of, tmp_path):
    """A message of FMI 2.0 is a format of printf, one of FMI 3.0 is the text."""
    messages: list[str] = []
    description = read_model_description(fmu_of("crane", kind))
    folder = Path(fmpy.extract(fmu_of("crane", kind), tmp_path))
    with pytest.raises(Exception, match="instantiate"):
        Instance(description, folder, "crane", lambda *message: messages.append(message[2]), token="{100% of #r1#}")
    assert "{100% of #r1#}" in messages[-1]


def test_sources_and_documentation_are_not_unpacked(fmu_of, tmp_path):
    unpack(fmu_of("crane", "fmi3"), tmp_path)
    actual = {file.relative_to(tmp_path).as_posix() for file in tmp_path.rglob("*") if file.is_file()}
    with zipfile.ZipFile(fmu_of("crane", "fmi3")) as fmu:
        packed_only = set(fmu.namelist()) - actual
        assert len(actual) + len(packed_only) == len(fmu.namelist())
    assert {name.partition("/")[0] for name in packed_only} == {"sources", "documentation"}
    assert {name.partition("/")[0] for name in actual} >= {"modelDescription.xml", "binaries", "resources"}
    assert len(packed_only) > len(actual)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scene", "rows"),
    [
        ("crane", '# held: torque\n"time","torque"\n0,0\n0.2,4\n0.6,4\n0.6,-3\n1,0\n'),
        ("switched", '# held: pull\n"time","pull","gear"\n0,0,1\n0.3,2,2\n0.7,-1,-1\n1,0,3\n'),
    ],
)
def test_with_held_inputs_results_are_the_same_bytes(scene, rows, fmu_of, tmp_path):
    (tmp_path / "table.csv").write_text(rows)
    tables = []
    for kind in kinds.IN_C:
        done = run(main, fmu_of(scene, kind), "-m", tmp_path / "table.csv", "--step", H, "--out", tmp_path / kind)
        assert done.returncode == 0, done.stderr
        tables += [file.read_bytes() for file in (tmp_path / kind).glob("*.csv")]
        assert "inputs held over a step" not in done.stdout  # the table wants it so
    assert tables[0] == tables[1] == tables[2]
    assert len(tables[0].splitlines()) == 102


@pytest.mark.slow
def test_what_goes_straight_is_held_and_late_and_this_is_reported(fmu_of, tmp_path):
    """Without intermediate update half a step late: as the FMU of FMI 2.0 with a table that is late by that.

    With it, as our FMUs have it, nothing is late.
    """
    without = {DESCRIPTION: lambda data: data.replace(b'ntermediateUpdate="true"', b'ntermediateUpdate="false"')}
    plain = changed_fmu(fmu_of("crane", "fmi3"), tmp_path / "plain.fmu", without)
    t = np.arange(0.0, 1.001, H)
    torque = 3.0 * np.sin(4.0 * t)
    for name, at in (("table", t), ("later", np.append(0.0, t[1:] + 0.5 * H))):
        rows = "".join(f"{x},{y}\n" for x, y in zip(at.tolist(), torque.tolist(), strict=True))
        (tmp_path / f"{name}.csv").write_text(f'"time","torque"\n{rows}')
    results = {}
    for kind, table in (("native", "table"), ("fmi3", "table"), ("plain", "table"), ("native", "later")):
        fmu = plain if kind == "plain" else fmu_of("crane", kind)
        done = run(main, fmu, "-m", tmp_path / f"{table}.csv", "--step", H, "--out", tmp_path / "out")
        assert done.returncode == 0, done.stderr
        assert ("torque: 5 ms late on average" in done.stdout) == (kind == "plain")
        assert ("late on average" in done.stdout) == (kind == "plain")
        (written,) = (Path(line.split()[1].rstrip(",")) for line in done.stdout.splitlines() if "written:" in line)
        results[kind, table] = read_csv(written)["rod.x"]
    lag = float(np.abs(results["plain", "table"] - results["native", "table"]).max())
    difference = float(np.abs(results["plain", "table"] - results["native", "later"]).max())
    assert lag > 1e-4
    assert difference < 0.1 * lag
    assert float(np.abs(results["fmi3", "table"] - results["native", "table"]).max()) < 0.1 * lag


@pytest.mark.slow
def test_states_and_start_values_are_those_of_fmi_2(fmu_of):
    for kind in kinds.IN_C:
        with Fmu(fmu_of("crane", kind)) as fmu, Fmu(fmu_of("crane", kind)) as other:
            fmu.initialise({"torque": 2.0}, 5.0)
            read, again = (one.getter(["rod.x", "rod.angle"]) for one in (fmu, other))
            fmu.step(5.0, H)
            kept, state = fmu.state_bytes(), fmu.state()
            fmu.step(5.0 + H, H)
            end = read()
            fmu.restore(state)
            fmu.free(state)
            fmu.step(5.0 + H, H)
            other.restore_bytes(kept)
            other.step(5.0 + H, H)
            assert read() == again() == end


def test_elements_of_arrays_without_names_are_counted(fmu_of, tmp_path):
    named = fmu_of("crane", "fmi3")
    bare = changed_fmu(named, tmp_path / "bare.fmu", {ELEMENTS: None})
    assert [v.name for v in described(named).modelVariables if v.name != "time"] == [
        v.name for v in described(fmu_of("crane", "native")).modelVariables
    ]
    with Fmu(named) as fmu, Fmu(bare) as other:
        assert "body.rod.position[1]" in other.names("output")
        values = []
        for one in (fmu, other):
            one.initialise({"torque": 2.0})
            one.step(0.0, H)
            values.append(one.getter(one.names("output"))())
        assert values[0] == values[1]
