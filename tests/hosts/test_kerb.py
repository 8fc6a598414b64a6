"""The host of the paper's test and its filter."""

from __future__ import annotations

from pathlib import Path

import fmpy
import numpy as np
import pytest

from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_fidelities
from hosts.measures.low_pass import low_pass
from hosts.run import kerb

PLATFORM = fmpy.platform


@pytest.fixture(scope="module")
def fmu(tmp_path_factory: pytest.TempPathFactory) -> Path:
    name, systems, default = load_fidelities("kerb_test")
    return build_fmu(systems, name, tmp_path_factory.mktemp("kerb"), [PLATFORM], fidelity=default)


def test_the_picture_and_the_table(fmu: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert kerb.main([str(fmu), "--fidelity", "1", "--out", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert all(f"\n{g} " in said for g in kerb.GAUGES)
    assert "Newton iterations" in said
    assert (tmp_path / "kerb_test.png").read_bytes().startswith(b"\x89PNG")
    head, *rows = (tmp_path / "kerb_test.csv").read_text().splitlines()
    assert '"bending_moment.SG1"' in head
    assert len(rows) == 1501


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--fidelity", "0"], "not computed"),
        (["--fidelity", "0.5"], "whole number"),
        (["--step", "0.1"], "below 0.05 s"),
        (["--step", "nan"], "must be positive"),
        (["--set", "road.friction=9"], "--set: 'road.friction' is 9; its range is 0 to 2"),
        (["--fidelity", "1", "--set", "fidelity=1"], "give it once"),
        (["--parameters", "no.ssv"], "no parameter set no.ssv"),
    ],
)
def test_what_it_refuses(
    fmu: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], options: list[str], said: str
) -> None:
    assert kerb.main([str(fmu), "--out", str(tmp_path), *options]) == 2
    assert said in capsys.readouterr().err


def test_a_folder_that_cannot_be_made_is_named(fmu: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    assert kerb.main([str(fmu), "--out", str(tmp_path / "file" / "out")]) == 2
    assert "cannot be made" in capsys.readouterr().err


def test_a_missing_fmu_is_named(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    assert kerb.main([]) == 2
    assert "build_fmu.py --scene kerb_test" in capsys.readouterr().err


def test_the_filter_keeps_slow_and_removes_fast() -> None:
    t = 0.01 * np.arange(1001)
    slow, fast = np.sin(2 * np.pi * 1.0 * t), np.sin(2 * np.pi * 40.0 * t)
    inner = (t > 1.0) & (t < 9.0)
    assert np.abs(low_pass(slow, 0.01) - slow)[inner].max() < 1e-3
    assert np.abs(low_pass(fast, 0.01))[inner].max() < 1e-2
    half = np.cos(2 * np.pi * 10.0 * t)
    assert np.abs(low_pass(half, 0.01))[inner].max() == pytest.approx(0.5, rel=0.02)  # half the power, twice
    with pytest.raises(ValueError, match="needs samples closer than 0.05 s"):
        low_pass(slow, 0.1)
