"""Arrays of FMI 3.0 that are inputs or parameters are set by their elements, in runs and in studies."""

import zipfile
from pathlib import Path

import fmpy
import numpy as np
import pandas as pd
import pytest
from fmpy.fmi1 import FMICallException
from numpy.typing import NDArray
from scipy.linalg import expm

from fmu_src.native.sources import HERE as FMI_HEADERS
from hosts.check.all_checks import CHECKS, run_check
from hosts.check.instance import Instance, open_subject
from hosts.common.errors import HostError
from hosts.fmu.fmu import Fmu
from hosts.run.command import main as run_command
from hosts.study.command import main as study
from hosts.study.store import read_study
from mbs.kernel import build
from tests.hosts.changed_fmu import DESCRIPTION, changed_fmu
from tests.in_process import run

HERE = Path(__file__).parent
A, B = np.array([[0.0, 1.0], [-4.0, -0.4]]), np.array([[0.0, 0.0, 0.0], [1.0, 0.5, 0.25]])
H = 0.01  # s


@pytest.fixture(scope="module")
def fmu(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("state_space")
    library = folder / f"StateSpace{fmpy.sharedLibraryExtension}"
    source = HERE / "state_space" / "state_space.c"
    build.compile_c([source], build.host_target(), library, include=(FMI_HEADERS,), what="the FMU")
    file = folder / "StateSpace.fmu"
    with zipfile.ZipFile(file, "w") as archive:
        archive.write(HERE / "state_space" / "modelDescription.xml", "modelDescription.xml")
        archive.write(library, f"binaries/{fmpy.platform_tuple}/{library.name}")
    return file


def motion(u: NDArray[np.float64], a: NDArray[np.float64] = A, b: NDArray[np.float64] = B) -> NDArray[np.float64]:
    """States at the ends of steps of H with inputs of shape (steps, 3) that are held, by the matrix exponential."""
    whole = np.zeros((5, 5))
    whole[:2, :2], whole[:2, 2:] = a, b
    step = expm(whole * H)
    x = [np.zeros(2)]
    for inputs in u:
        x.append(step[:2, :2] @ x[-1] + step[:2, 2:] @ inputs)
    return np.array(x)


def test_a_run_with_inputs_and_parameters_that_are_elements(fmu: Path, tmp_path: Path) -> None:
    """Two of three inputs move, the third keeps its start value, and so do elements of parameters beside those set."""
    table = tmp_path / "table.csv"
    table.write_text('# held: u[1], u[3]\n"time","u[1]","u[3]"\n0,0.5,-1\n0.4,2,-1\n0.4,2,1\n1,0,0\n')
    values = ["--set", "A[2,1]=-9", "--set", "gain[2]=3", "--set", "on[2]=false"]
    done = run(run_command, fmu, "-m", table, "--step", H, "--out", tmp_path / "out", *values)
    assert done.returncode == 0, done.stderr
    (file,) = (tmp_path / "out").glob("*.csv")
    result = pd.read_csv(file, comment="#")
    u = np.where(np.arange(100)[:, None] < 40, [0.5, 0.0, -1.0], [2.0, 0.0, 1.0])
    expected = motion(u, np.array([[0.0, 1.0], [-9.0, -0.4]])) * [1.0, 3.0]
    got = np.column_stack([result[next(n for n in result if n.startswith(f"y[{k}]"))] for k in (1, 2)])
    assert np.abs(got - expected).max() < 1e-6 * np.abs(expected).max()
    assert np.abs(expected).max() > 0.5


@pytest.mark.slow
def test_a_study_over_elements(fmu: Path, tmp_path: Path) -> None:
    file = tmp_path / "study.toml"
    file.write_text(
        f'fmu = "{fmu}"\nstep = {H}\n[start]\n"u[2]" = 0.0\n[[manoeuvres]]\nname = "step"\nstop_time = 1.0\n'
        '[sampling]\nmethod = "grid"\n[parameters]\n"A[2,1]" = { values = [-1.0, -16.0] }\n'
        '"B[2,3]" = { values = [0.0, 0.5] }\n[measures]\nhighest = "max(y[1])"\n'
    )
    assert study([str(file), "--out", str(tmp_path / "out"), "--jobs", "1", "--no-report"]) == 0
    frame = read_study(tmp_path / "out")
    assert list(frame["status"]) == ["done"] * 4
    for _, row in frame.iterrows():
        a, b = A.copy(), B.copy()
        a[1, 0], b[1, 2] = row["A[2,1]"], row["B[2,3]"]
        expected = motion(np.tile([1.0, 0.0, 3.0], (100, 1)), a, b)[:, 0].max()
        assert row["highest"] == pytest.approx(expected, rel=1e-6)
    assert frame["highest"].std() > 0.05


def test_elements_that_are_not_set_keep_their_values(fmu: Path) -> None:
    """After a restored state those of the state, after a reset those of the start."""
    with Fmu(fmu) as one:
        one.initialise({"u[2]": 5.0})
        read, push = one.getter(["u[1]", "u[2]", "u[3]"]), one.setter(["u[1]"])
        assert read() == [1.0, 5.0, 3.0]
        state = one.state()
        one.setter(["u[3]", "A[1,1]"])([7.0, -1.0])
        push([4.0])
        assert read() == [4.0, 5.0, 7.0]
        one.restore(state)
        one.free(state)
        push([6.0])
        assert read() == [6.0, 5.0, 3.0]
        one.reset()
        one.initialise({"u[3]": 8.0})
        assert read() == [1.0, 2.0, 8.0]


def test_an_array_as_a_whole_is_refused_with_its_elements(fmu: Path) -> None:
    with Fmu(fmu) as one, pytest.raises(HostError, match=r"'B' is an array .* its elements, 'B\[1,1\]' to 'B\[2,3\]'"):
        one.table.settable("B", "--set")


def described_as(fmu: Path, folder: Path, change: dict[str, str]) -> Path:
    """The same FMU with other words in its description."""

    def other(description: bytes) -> bytes:
        for old, new in change.items():
            assert old.encode() in description
            description = description.replace(old.encode(), new.encode())
        return description

    return changed_fmu(fmu, folder / "Changed.fmu", {DESCRIPTION: other})


def test_texts_of_an_array_are_not_split_and_not_set(fmu: Path, tmp_path: Path) -> None:
    """FMPy knows the first start value alone; to set one element would set the others to what is not known."""
    array = (
        '<String name="label" valueReference="8" causality="parameter" variability="fixed"><Dimension start="2"/>'
        '<Start value="two words"/><Start value="other"/></String></ModelVariables>'
    )
    with Fmu(described_as(fmu, tmp_path, {"</ModelVariables>": array})) as one:
        assert [one.variables[f"label[{k}]"].start for k in (1, 2)] == ["two words", None]
        with pytest.raises(HostError, match=r"'label\[2\]' is one of 2 elements of an array of type String; such"):
            one.initialise({"label[2]": "mine"})
        one.initialise({"u[2]": 5.0})
        with pytest.raises(HostError, match=r"'label\[1\]' is one of 2 elements"):
            one.setter(["u[1]", "label[1]"])([7.0, "mine"])  # type: ignore[list-item]
        assert one.getter(["u[1]", "u[2]"])() == [1.0, 5.0], "nothing is half set"


def test_a_refused_value_does_not_stay(fmu: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with Fmu(fmu) as one:
        one.initialise({})
        read = one.getter(["u[1]", "u[2]"])
        take = one._slave.setFloat64

        def refuse(*arguments: object) -> None:
            raise FMICallException("fmi3SetFloat64", 3)

        monkeypatch.setattr(one._slave, "setFloat64", refuse)
        with pytest.raises(HostError, match="refused"):
            one.setter(["u[1]"])([1e9])
        monkeypatch.setattr(one._slave, "setFloat64", take)
        one.setter(["u[2]"])([4.0])
        assert read() == [1.0, 4.0]


def test_an_fmu_without_outputs_runs(fmu: Path, tmp_path: Path) -> None:
    hidden = {'name="y" valueReference="7" causality="output"': 'name="y" valueReference="7" causality="local"',
              '<Output valueReference="7"/>': ""}  # fmt: skip
    options = ("--stop-time", "0.25", "--out", tmp_path, "--interval", "0.1")
    done = run(run_command, described_as(fmu, tmp_path, hidden), *options)
    assert done.returncode == 0, done.stderr
    (file,) = tmp_path.glob("*.csv")
    assert pd.read_csv(file)["time"].iloc[-1] == 0.25


@pytest.mark.slow
def test_a_table_at_an_interval_repeats_its_run_or_reports_that_it_cannot(fmu: Path, tmp_path: Path) -> None:
    """Here inputs are held over each step."""
    tables = {"moves": "0,0\n0.25,2\n", "stays": "0,1\n0.1,1\n0.1,2\n0.25,2\n"}
    results = {}
    for name, rows in tables.items():
        table = tmp_path / f"{name}.csv"
        table.write_text(f'"time","u[1]"\n{rows}')
        done = run(run_command, fmu, "-m", table, "--step", H, "--interval", "0.1", "--out", tmp_path / name)
        assert done.returncode == 0, done.stderr
        assert "rows every 0.1 s" in done.stdout
        (results[name],) = (tmp_path / name).glob("*.csv")
        assert pd.read_csv(results[name])["time"].tolist() == pytest.approx([0.0, 0.1, 0.2, 0.25])
    again = run(run_command, fmu, "-m", results["moves"], "--out", tmp_path / "again")
    assert again.returncode == 2
    assert "was written every 0.1 s, and u[1] moved in between" in again.stderr
    assert "run without --interval to have a table that repeats" in again.stderr
    again = run(run_command, fmu, "-m", results["stays"], "--interval", "0.1", "--out", tmp_path / "again")
    assert again.returncode == 0, again.stderr
    (repeated,) = (tmp_path / "again").glob("*.csv")
    assert repeated.read_text().splitlines()[1:] == results["stays"].read_text().splitlines()[1:]


def test_checks_drive_elements_of_inputs(fmu: Path, tmp_path: Path) -> None:
    """Values before the start, strong inputs, NaN and derivatives reach each element."""
    hidden = '<Output valueReference="7" dependencies=""/>'
    silent = described_as(fmu, tmp_path, {'<Output valueReference="7"/>': hidden})
    (tmp_path / "told").mkdir()
    complete = described_as(fmu, tmp_path / "told", {'<Output valueReference="7"/>': hidden.replace('""', '"1"')})
    lines = {}
    for place, path in enumerate((fmu, silent, complete)):
        subject = open_subject(path, tmp_path / f"open{place}", 5, {"A[2,1]": -9.0, "u[2]": 4.0})
        names = ("runs", "refusals", "refused steps", "dependencies", "derivatives")
        lines[path] = {c.name: run_check(c, subject).words for c in CHECKS if c.name in names}
    assert lines[fmu]["runs"] == "5 steps of 0.01 s, 2 outputs move"
    assert "NaN for an input" in lines[fmu]["refusals"]
    assert lines[fmu]["refused steps"].startswith("a refused step at 0 s can be asked for without end")
    for path in (fmu, complete):
        assert lines[path]["dependencies"].startswith("1 outputs, such as y, are said to depend on inputs")
    assert lines[silent]["dependencies"] == "outputs change at a communication point as they are said to"
    assert lines[silent]["derivatives"].startswith("they are those over the last step")
    assert [v.name for v in subject.inputs] == ["u[1]", "u[2]", "u[3]"]
    values = np.array(Instance(subject).start().run(5))
    expected = motion(np.tile([1.0, 4.0, 3.0], (5, 1)), np.array([[0.0, 1.0], [-9.0, -0.4]]))[1:]
    assert np.abs(values - expected).max() < 1e-8
