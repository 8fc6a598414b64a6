"""The share of a study's runs within limits."""

import csv
import json
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from hosts.study.command import main
from hosts.study.limits import share_notes, share_rows, shares
from hosts.study.store import read_study
from hosts.study.worker_data import ALL
from tests.hosts.study.frames import frame_of

UNITS = {"k": "N/m", "gradient": "rad.s2/m", "speed": "m/s"}
GRADIENT = {"gradient": {"min": 0.0, "max": 2.0, "unit": "rad.s2/m"}}


def made_frame(method: str = "sobol") -> pd.DataFrame:
    """Ten runs: gradients -1 to 8, a speed that six of them have; the last two runs have no result."""
    speed = np.where(np.arange(10) < 6, 30.0, np.nan)
    frame = frame_of({"k": np.arange(10.0)}, {"gradient": np.arange(10.0) - 1.0, "speed": speed}, UNITS, method=method)
    frame.loc[8, ["status", "gradient", "speed"]] = ["failed", np.nan, np.nan]
    frame.loc[9, ["status", "missing", "gradient", "speed"]] = ["incomplete", "gradient", np.nan, 20.0]
    frame.attrs["limits"] = GRADIENT | {"speed": {"min": 25.0, "max": None, "unit": "m/s"}}
    return frame


def test_counts_by_hand() -> None:
    gradient, speed, all_limits = shares(made_frame())
    # 0, 1 and 2 are within; -1, 3 to 6 and the two without a result are not
    assert (gradient.within, gradient.outside, gradient.without_result, gradient.absent) == (3, 7, 2, 0)
    # of the speed the failed run has no result; two runs have no such speed, and run 9 has one that is too low
    assert (speed.within, speed.outside, speed.without_result, speed.absent) == (6, 2, 1, 2)
    assert (all_limits.measure, all_limits.within, all_limits.outside) == (ALL, 3, 7)


def test_a_measure_that_does_not_exist_is_distinguished_from_one_that_is_missing() -> None:
    """Two runs lack another measure: in the first there is no speed either, in the second it should be there."""
    frame = made_frame()
    frame.loc[8, ["status", "missing"]] = ["incomplete", "gradient"]
    frame.loc[9, ["gradient", "speed", "missing"]] = [1.0, np.nan, "peak, speed"]
    gradient, speed, all_limits = shares(frame)
    assert (gradient.within, gradient.outside, gradient.without_result, gradient.absent) == (4, 6, 1, 0)
    assert (speed.within, speed.outside, speed.without_result, speed.absent) == (6, 1, 1, 3)
    assert (all_limits.within, all_limits.outside, all_limits.without_result) == (3, 7, 2)


def test_a_test_whose_name_begins_with_that_of_another() -> None:
    frame = frame_of(
        {"k": np.arange(2.0)}, {"turn.left.speed": [30.0, np.nan, 20.0, np.nan]}, {}, manoeuvres=("turn.left", "turn")
    )
    frame.attrs |= {"tests": ["turn", "turn.left"], "units": {"turn.left.speed": "m/s"}}
    frame.attrs["limits"] = {"turn.left.speed": {"min": 25.0, "max": None, "unit": "m/s"}}
    frame.loc[frame["manoeuvre"] == "turn", "status"] = "failed"
    speed, _ = shares(frame)
    assert (speed.manoeuvre, speed.within, speed.outside) == ("turn.left", 1, 1)


def test_the_interval_is_wilsons() -> None:
    share = shares(made_frame())[0]
    # E. B. Wilson, JASA 22, 1927, 209-212: the roots of (p - k/n)^2 = z^2 p (1 - p) / n
    n, p, z = 10, 0.3, 1.959963984540054
    middle = (p + z * z / (2 * n)) / (1 + z * z / n)
    half = z / (1 + z * z / n) * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    assert (share.share_low, share.share_high) == pytest.approx((middle - half, middle + half), rel=1e-12)


@pytest.mark.parametrize("method", ["grid", "table", "saltelli"])
def test_runs_that_are_no_random_sample_have_no_interval(method: str) -> None:
    frame = made_frame(method)
    found = shares(frame)
    assert all(math.isnan(s.share_low) and math.isnan(s.share_high) for s in found)
    assert found[0].share == 0.3
    assert share_notes(found, frame.attrs)[0].startswith("There is no interval: ")


def test_texts_are_in_display_units() -> None:
    frame = made_frame()
    rows = share_rows(shares(frame), frame.attrs)
    assert rows[0][:4] == ("gradient", "0 to 1123.8 deg/g", "3 of 10 runs, 2 without a result", "30.0 %")
    assert rows[1][1:3] == ("at least 90 km/h", "6 of 8 runs, 1 without a result; 2 more do not have it")
    assert rows[2][:3] == ("all limits", "", "3 of 10 variants, 2 without a result")


def test_variants_keep_all_limits_in_all_their_manoeuvres() -> None:
    gradient = np.array([0.0, 5.0, 1.0, 1.0, 5.0, 5.0])
    frame = frame_of({"k": np.arange(3.0)}, {"gradient": gradient}, UNITS, manoeuvres=("left", "right"))
    frame.attrs["limits"] = GRADIENT
    left, right, both = shares(frame)
    assert [(s.within, s.outside) for s in (left, right, both)] == [(2, 1), (1, 2), (1, 2)]


@pytest.mark.usefixtures("in_process")
def test_a_study_with_limits(
    study_file: Callable[..., Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The exit code, the files and the words; then other limits for runs that are there."""
    out = ["--out", str(tmp_path / "out"), "--no-report"]
    file = study_file(more='[limits]\nlowest = { min = -1.2 }\nhighest = { max = 1.0, unit = "m" }\n')
    assert main([str(file), *out]) == 1
    frame = read_study(tmp_path / "out")
    within = int((frame["lowest"] >= -1.2).sum())
    assert 0 < within < 16
    assert f"{within} of 16 runs" in capsys.readouterr().out
    record = json.loads((tmp_path / "out" / "limits.json").read_text(encoding="utf-8"))
    assert [(r["measure"], r["within"]) for r in record] == [("lowest", within), ("highest", 16), (ALL, within)]
    with (tmp_path / "out" / "limits.csv").open(encoding="utf-8") as stream:
        assert [int(row["outside"]) for row in csv.DictReader(stream)] == [16 - within, 0, 16 - within]
    study_file(more="[limits]\nlowest = { min = -12.0 }\n")
    assert main([str(file), *out]) == 0
    assert "16 of 16 variants" in capsys.readouterr().out
