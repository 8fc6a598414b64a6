"""The report of a study on frames whose truth is known."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib import image
from scipy.stats import qmc

from hosts.common.errors import HostError
from hosts.study.analysis.data import study_data
from hosts.study.analysis.effect_plots import failed_share
from hosts.study.analysis.report import report_of
from hosts.study.analysis.summary_plots import rank_correlations
from hosts.study.analysis.tables import extremes, reasons, said, statistics
from tests.hosts.study.frames import frame_of

UNITS = {"stiffness": "N/m", "mass": "kg", "surface": "", "peak": "m/s2"}


@pytest.fixture(scope="module")
def frame() -> pd.DataFrame:
    """Runs of which those with a soft spring fail."""
    u = qmc.LatinHypercube(3, rng=1).random(200)
    surface = np.where(u[:, 2] < 0.5, "ice", "dry")
    x = {"stiffness": 2e4 + 4e4 * u[:, 0], "mass": 1e3 * 10.0 ** u[:, 1], "surface": surface}
    measures = {"peak": 5.0 - 1e-4 * x["stiffness"] + 2.0 * (surface == "dry")}
    return frame_of(x, measures, UNITS, failed=lambda f: f["stiffness"] < 2.8e4, log=["mass"])


def commands(index: int) -> list[str]:
    return [f"ali3 run Car.fmu -m 'a & b' --set x={index}", f"ali3 view Car.fmu {index}"]


def test_the_whole_report(frame: pd.DataFrame, tmp_path: Path) -> None:
    files = report_of(frame, tmp_path, commands)
    text = files[0].read_text(encoding="utf-8")
    assert files[0] == tmp_path / "report.html"
    assert files[1] == tmp_path / "analysis"
    assert "200 of 200: 160 done, 40 failed" in text
    assert "160 of 200" in text  # runs that yield the measure
    assert "The FMU refused the step at … s." in text
    # Failed runs come first, and the highest run with the command that repeats it, escaped once.
    highest = int(frame["peak"].idxmax())
    assert f"<code>ali3 run Car.fmu -m 'a &amp; b' --set x={highest}</code>" in text
    assert f"<code>ali3 view Car.fmu {int(frame['peak'].idxmin())}</code>" in text
    assert not re.search(r'(src|href)="(?!data:)', text)  # nothing outside of the file
    assert text.count("data:image/png") == 6
    for picture in files[1].glob("*.png"):
        assert len(np.unique(image.imread(picture)[..., :3].reshape(-1, 3), axis=0)) > 20
    table = pd.read_csv(tmp_path / "analysis" / "effects.csv").set_index("parameter")
    # Class means of the stiffness differ by 9/10 of its range that is left; those of the surface by 2.
    assert table.loc["stiffness", "main_effect_span"] == pytest.approx(0.9 * 3.2, abs=0.8)
    assert table.loc["surface", "main_effect_span"] == pytest.approx(2.0, abs=0.4)
    assert table.loc["stiffness", "first"] == pytest.approx(3.2**2 / 12 / (3.2**2 / 12 + 1.0), abs=0.2)


def test_half_a_study_says_so(frame: pd.DataFrame, tmp_path: Path) -> None:
    half = frame.iloc[:60]
    half.attrs = frame.attrs
    text = report_of(half, tmp_path, commands)[0].read_text(encoding="utf-8")
    assert "140 of 200 runs are not done yet; this is the report of the others." in text
    with pytest.raises(HostError, match="has no run yet"):
        report_of(frame.iloc[:0], tmp_path, commands)


def test_all_runs_failed(frame: pd.DataFrame, tmp_path: Path) -> None:
    lost = frame.copy()
    lost["status"], lost["peak"], lost["reason"] = "failed", np.nan, "The worker was killed."
    text = report_of(lost, tmp_path, commands)[0].read_text(encoding="utf-8")
    assert "No run yields a measure." in text
    assert "The worker was killed." in text


def test_a_measure_that_never_changes(tmp_path: Path) -> None:
    made = frame_of({"mass": np.arange(100.0)}, {"peak": np.full(100, 3.0)}, UNITS)
    text = report_of(made, tmp_path, commands)[0].read_text(encoding="utf-8")
    assert "The measure is 3 in all runs." in text


def test_where_runs_fail(frame: pd.DataFrame) -> None:
    data = study_data(frame)
    at, share, low, high = failed_share(data.x[:, 0], data.failed)
    # A fifth of the range fails: the first two of ten classes wholly, the others not at all.
    assert share.tolist() == [1.0, 1.0, *[0.0] * 8]
    assert at[1] < 2.8e4 < at[2]
    # Wilson's interval of 0 of 20 is up to z^2 / (n + z^2).
    assert high[5] == pytest.approx(1.96**2 / (20 + 1.96**2), rel=1e-3)
    assert low[0] == pytest.approx(1.0 - high[5], rel=1e-6)


def test_extremes_reasons_and_statistics(frame: pd.DataFrame) -> None:
    data = study_data(frame)
    (peak,) = data.responses
    highest, lowest = extremes(data, peak, 3)
    assert [r.index for r in highest] == frame["peak"].nlargest(3).index.tolist()
    assert [r.index for r in lowest] == frame["peak"].nsmallest(3).index.tolist()
    assert highest[0].value == frame["peak"].max()
    ((reason, runs),) = reasons(data, "failed")
    assert reason == "The FMU refused the step at … s."
    assert runs == frame.index[frame["status"] == "failed"].tolist()
    assert statistics(peak)["5 %"] == pytest.approx(frame["peak"].quantile(0.05))


def test_what_the_fmu_said(frame: pd.DataFrame, tmp_path: Path) -> None:
    told = frame.iloc[:70].copy()
    told["messages"] = [f"The step {1 + k} ms is coarse." if k % 7 == 0 else "" for k in range(70)]
    told.attrs = frame.attrs
    assert said(study_data(told)) == [("The step … ms is coarse.", list(range(0, 70, 7)))]
    text = report_of(told, tmp_path, commands)[0].read_text(encoding="utf-8")
    assert "What the FMU said" in text
    assert "The step … ms is coarse." in text


def test_two_manoeuvres_are_two_responses() -> None:
    x = np.linspace(1.0, 2.0, 50)
    made = frame_of({"mass": x}, {"peak": np.stack([x, -x], axis=1).ravel()}, UNITS, manoeuvres=("slalom", "drop"))
    data = study_data(made)
    assert [r.label for r in data.responses] == ["peak (slalom)", "peak (drop)"]
    assert data.responses[1].values == pytest.approx(-x)
    assert data.points(data.responses[1]).tolist() == list(range(50))
    assert rank_correlations(data, data.responses).ravel().tolist() == pytest.approx([1.0, -1.0])


def test_a_design_of_saltellis_with_failed_runs(tmp_path: Path) -> None:
    """A linear model: the indices of the report are those of the closed form."""
    from SALib.sample import sobol

    problem = {"num_vars": 2, "names": ["a", "b"], "bounds": [[0.0, 1.0]] * 2}
    x = sobol.sample(problem, 256, calc_second_order=False, seed=4)
    y = 3.0 * x[:, 0] - x[:, 1]
    made = frame_of({"a": x[:, 0], "b": x[:, 1]}, {"y": y}, {}, method="saltelli", failed=lambda f: f.index % 100 == 50)
    text = report_of(made, tmp_path, commands)[0].read_text(encoding="utf-8")
    assert "blocks with a missing or failed run left out: 10." in text
    table = pd.read_csv(tmp_path / "analysis" / "effects.csv").set_index("parameter")
    assert table["first"].tolist() == pytest.approx([0.9, 0.1], abs=0.03)
    assert table["total"].tolist() == pytest.approx([0.9, 0.1], abs=0.02)
