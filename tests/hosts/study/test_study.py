"""A study from its file to its table."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from hosts.common.errors import HostError
from hosts.study.campaign import run_study
from hosts.study.plan import make_plan
from hosts.study.store import open_signals, read_study
from hosts.study.study_file import read_study_file
from hosts.study.study_runs import Bench
from tests.hosts.in_this_process import in_this_process

GRAVITY = 9.81
STUDY = (Path(__file__).parent / "study.txt").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def folder(tuned: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study that is done."""
    place = tmp_path_factory.mktemp("study")
    signals = '[signals]\nnames = ["bob.y", "pull"]\ninterval = 0.05\n'
    (place / "study.toml").write_text(STUDY.format(fmu=tuned) + signals)
    with in_this_process():
        ended = run_study(place / "study.toml", place / "out", None, 1)
    assert ended is not None
    assert ended.good
    return ended.folder


def test_rows_are_the_closed_form_of_each_point(folder):
    table = read_study(folder)
    assert list(table.index) == list(range(16))
    assert (table["status"] == "done").all()
    k, free = table["spring.stiffness"], table["spring.free_length"]
    assert k.between(50.0, 80.0).all()
    assert k.nunique() == 16
    # undamped, at rest at y = -1: it swings about the equilibrium, as far on the other side
    middle = -(free + 2.0 * GRAVITY / k)
    ends = np.stack([np.full(16, -1.0), 2.0 * middle + 1.0])
    assert table["highest"].to_numpy() == pytest.approx(ends.max(axis=0), abs=2e-3)
    assert table["lowest"].to_numpy() == pytest.approx(ends.min(axis=0), abs=2e-3)
    assert table["highest"].std() > 0.02
    assert table["simulated"].to_numpy() == pytest.approx(2.0)


def test_pandas_opens_the_parts_with_units_and_origin(folder):
    table = pd.read_parquet(folder / "runs")
    assert table.attrs["units"]["spring.stiffness"] == "N/m"
    assert table.attrs["units"]["lowest"] == "m"
    record = json.loads((folder / "study.json").read_text())
    assert table.attrs["guid"] == record["guid"]
    assert table.attrs["seed"] == 7
    assert table.attrs["versions"]["ali3"] == record["versions"]["ali3"]
    part = next((folder / "runs").glob("*.parquet"))
    assert pq.read_schema(part).field("lowest").metadata[b"unit"] == b"m"
    assert read_study(folder).attrs == table.attrs


def test_xarray_opens_the_signals(folder):
    data, table = open_signals(folder), read_study(folder)
    assert data["bob.y"].shape == (16, 41)
    assert data["time"].to_numpy() == pytest.approx(0.05 * np.arange(41))
    assert data["bob.y"].attrs["units"] == "m"
    assert data["bob.y"].to_numpy()[:, 0] == pytest.approx(-1.0)
    assert data["bob.y"].min("time").to_numpy() == pytest.approx(table["lowest"].to_numpy(), abs=5e-3)
    assert data["spring.stiffness"].to_numpy().tolist() == table["spring.stiffness"].tolist()
    assert (data["pull"] == 0.0).all()


def columns(folder: Path) -> dict[str, object]:
    """Every column but the time it took, as bits."""
    table = read_study(folder).drop(columns="wall_seconds")
    return {n: c.to_numpy().tobytes() if c.dtype.kind in "if" else c.tolist() for n, c in table.items()}


@pytest.mark.slow
def test_rows_have_the_bits_of_new_instances(folder):
    table = read_study(folder)
    file = folder.parent / "study.toml"
    study, _ = read_study_file(file)
    plan = make_plan(study, file, Path(study.fmu or ""))
    assert not plan.work.reuse  # each run loads the FMU
    for index in range(plan.runs):
        values = {name: column[0] for name, column in plan.points.block(index, 1).items()}
        outcome = Bench(plan.work, plan.fmu).run(plan.work.jobs[0], values, 0)
        assert outcome.measures == dict(table.loc[index, ["lowest", "highest"]])


@pytest.mark.slow
def test_two_processes_of_their_own_give_the_same_bits(folder, tmp_path):
    assert run_study(folder.parent / "study.toml", tmp_path / "out", None, 2) is not None
    assert columns(tmp_path / "out") == columns(folder)
    assert open_signals(tmp_path / "out").equals(open_signals(folder))


def test_a_study_under_the_names_of_an_alias_file_makes_the_same_runs(study_file, tuned, tmp_path):
    (tmp_path / "names.toml").write_text(
        '"chassis.z" = { name = "bob.y", factor = -1.0 }\n"rate" = { name = "spring.stiffness", factor = 10.0 }\n'
    )
    ours = (
        ("[start]", 'aliases = "names.toml"\n[start]'),
        ('"spring.stiffness" = { range = [50.0, 80.0] }', '"rate" = { range = [5.0, 8.0] }'),
        ("min(bob.y)", "min(chassis.z)"),
        ("max(bob.y)", "max(chassis.z)"),
    )
    results = []
    for file, stiffness in (
        (study_file(), {"spring.stiffness": 60.0}),
        (study_file(*ours, name="named.toml"), {"rate": 6.0}),
    ):
        plan = make_plan(read_study_file(file)[0], file, tuned)
        assert set(plan.work.parameters) == {*stiffness, "spring.free_length"}
        bench = Bench(plan.work, tuned)
        results.append(bench.run(plan.work.jobs[0], {**stiffness, "spring.free_length": 0.7}, 1).measures)
        bench.close()
    theirs, named = results
    assert theirs["highest"] - theirs["lowest"] > 0.02
    assert named == {"lowest": -theirs["highest"], "highest": -theirs["lowest"]}
    wrong = study_file(*ours, ('"rate"', '"chassis.z"'))
    study = read_study_file(wrong)[0]
    with pytest.raises(HostError, match=r"'chassis.z' is not a parameter or input of the FMU; it cannot be set"):
        make_plan(study, wrong, tuned)
