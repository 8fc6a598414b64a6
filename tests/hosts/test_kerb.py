"""The host of the paper's test and its filter."""

import shutil
from pathlib import Path

import fmpy
import numpy as np
import pytest

import mbs
from ali3.low_pass import low_pass
from fmu_src.build.build import build_fmu
from hosts.fmu import built_fmu
from hosts.run import kerb
from hosts.run.command import main
from mbs.scenes import kerb_test

PLATFORM = fmpy.platform


@pytest.fixture(scope="module")
def fmu(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With the two fidelities that take little time."""
    systems = [mbs.compile(kerb_test.build(fidelity)) for fidelity in (0, 1)]
    return build_fmu(systems, "kerb_test", tmp_path_factory.mktemp("kerb"), [PLATFORM], fidelity=1)


@pytest.mark.slow
@pytest.mark.drawn
def test_the_picture_and_the_table(fmu, tmp_path, capsys):
    assert main(["--kerb", str(fmu), "--fidelity", "1", "--out", str(tmp_path)]) == 0
    output = capsys.readouterr().out
    assert all(f"\n{g} " in output for g in kerb.GAUGES)
    assert "Newton iterations" in output
    assert (tmp_path / "kerb_test.png").read_bytes().startswith(b"\x89PNG")
    head, *rows = (tmp_path / "kerb_test.csv").read_text().splitlines()
    assert '"bending_moment.SG1"' in head
    assert len(rows) == 1501


@pytest.mark.slow
def test_invalid_values_are_refused(fmu, tmp_path, capsys):
    for options, message in (
        (["--step", "0.1"], "below 0.05 s"),
        (["--set", "road.friction=9"], "--set: 'road.friction' is 9; its range is 0 to 2"),
        (["--fidelity", "1", "--set", "fidelity=1"], "give it once"),
    ):
        assert main(["--kerb", str(fmu), "--out", str(tmp_path), *options]) == 2
        assert message in capsys.readouterr().err
    with pytest.raises(SystemExit, match="2"):
        main(["--kerb", str(fmu), "--out", str(tmp_path), "--fidelity", "0.5"])
    assert "--fidelity: '0.5' is given; it must be a whole number" in capsys.readouterr().err


@pytest.mark.slow
def test_without_an_fmu_that_of_the_scene_is_built_and_kept(fmu, capsys, monkeypatch, tmp_path):
    """The build itself is tested elsewhere; here it takes the FMU that is there."""
    requested: list[tuple[str, ...]] = []

    def build(_: str, options: tuple[str, ...], folder: Path) -> None:
        requested.append(options)
        folder.mkdir(exist_ok=True)
        shutil.copy(fmu, folder)

    monkeypatch.setenv("ALI3_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(built_fmu, "build_fmu", build)
    monkeypatch.chdir(tmp_path)
    for sentence in ("The scene kerb_test is built for this machine", ""):
        assert main(["--kerb", "--fidelity", "1", "--out", str(tmp_path)]) == 0
        assert ("is built" in sentence) is ("is built" in capsys.readouterr().out)
    assert requested == [("--scene", "kerb_test")]
    assert main(["--kerb", "prototype"]) == 2
    assert "--kerb runs the scene kerb_test; --manoeuvre kerb_drop drives the car prototype" in capsys.readouterr().err
    assert main(["--kerb", str(fmu), "-m", "slalom"]) == 2
    assert "--manoeuvre cannot be combined with --kerb" in capsys.readouterr().err


def test_the_filter_keeps_slow_and_removes_fast():
    t = 0.01 * np.arange(1001)
    slow, fast = np.sin(2 * np.pi * 1.0 * t), np.sin(2 * np.pi * 40.0 * t)
    inner = (t > 1.0) & (t < 9.0)
    assert np.abs(low_pass(slow, 0.01) - slow)[inner].max() < 1e-3
    assert np.abs(low_pass(fast, 0.01))[inner].max() < 1e-2
    half = np.cos(2 * np.pi * 10.0 * t)
    assert np.abs(low_pass(half, 0.01))[inner].max() == pytest.approx(0.5, rel=0.02)  # half the power, twice
    with pytest.raises(ValueError, match="needs samples closer than 0.05 s"):
        low_pass(slow, 0.1)
