"""The report of a study on frames with known statistics."""

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib import pyplot as plt
from scipy.stats import qmc

from hosts.common.errors import HostError
from hosts.study.analysis.data import study_data
from hosts.study.analysis.indices import Indices
from hosts.study.analysis.main_effects import failed_share
from hosts.study.analysis.measure_section import indices_of
from hosts.study.analysis.report import report_of
from hosts.study.analysis.study_section import measures_section
from hosts.study.analysis.summary_plots import plot_distribution, plot_indices, rank_correlations
from hosts.study.analysis.tables import extremes, messages_with_runs, reasons, statistics
from tests.hosts.study.frames import frame_of

pytestmark = pytest.mark.drawn

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


@pytest.mark.slow
def test_the_whole_report(frame: pd.DataFrame, tmp_path: Path) -> None:
    files = report_of(frame, tmp_path, commands)
    text = files[0].read_text(encoding="utf-8")
    assert files[0] == tmp_path / "report.html"
    assert files[1] == tmp_path / "analysis"
    assert "200 of 200: 160 done, 40 failed" in text
    assert "160 of 200" in text  # runs that yield the measure
    assert re.search(r"The FMU refused the step at [\d.]+ to [\d.]+ s\.", text)
    # Failed runs come first, and the highest run with the command that repeats it, escaped once.
    highest = int(frame["peak"].idxmax())
    assert f"<code>ali3 run Car.fmu -m 'a &amp; b' --set x={highest}</code>" in text
    assert f"<code>ali3 view Car.fmu {int(frame['peak'].idxmin())}</code>" in text
    assert not re.search(r'(src|href)="(?!data:|#)', text)  # nothing outside of the file
    assert text.count("data:image/svg+xml") == 6
    assert sum(len(set(re.findall(rb"#[0-9a-f]{6}", f.read_bytes()))) > 3 for f in files[1].glob("*.svg")) == 6
    table = pd.read_csv(tmp_path / "analysis" / "effects.csv").set_index("parameter")
    # Class means of the stiffness differ by 9/10 of its range that is left; those of the surface by 2.
    assert table.loc["stiffness", "main_effect_span"] == pytest.approx(0.9 * 3.2, abs=0.8)
    assert table.loc["surface", "main_effect_span"] == pytest.approx(2.0, abs=0.4)
    assert table.loc["stiffness", "first"] == pytest.approx(3.2**2 / 12 / (3.2**2 / 12 + 1.0), abs=0.2)


@pytest.mark.slow
def test_plots_of_a_measure_with_a_long_name_have_a_file_each(tmp_path: Path) -> None:
    x = np.linspace(0.0, 1.0, 20)
    report_of(frame_of({"mass": x}, {"peak_" * 20: x**2}, {"mass": "kg", "peak_" * 20: "m"}), tmp_path, commands)
    text = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert len([*(tmp_path / "analysis").glob("*.svg")]) == text.count("data:image/svg+xml") == 5


@pytest.mark.slow
def test_the_report_of_an_incomplete_study_with_limits_and_messages(frame: pd.DataFrame, tmp_path: Path) -> None:
    half = frame.iloc[:60].copy()
    half["messages"] = [f"The step {1 + k} ms is coarse." if k % 7 == 0 else "" for k in range(60)]
    half.attrs = frame.attrs | {"limits": {"peak": {"min": 3.0, "max": None, "unit": "m/s2"}}}
    within = int((half["peak"] >= 3.0).sum())
    assert messages_with_runs(study_data(half)) == [("The step 1 to 57 ms is coarse.", list(range(0, 60, 7)))]
    text = report_of(half, tmp_path, commands)[0].read_text(encoding="utf-8")
    assert "The step 1 to 57 ms is coarse." in text.partition("Messages of the FMU")[2]
    assert "at least 3 m/s²" in text
    assert f"{within} of 60 runs" in text
    assert "140 of 200 runs are not done yet; this is the report of the others." in text
    with pytest.raises(HostError, match="has no run yet"):
        report_of(frame.iloc[:0], tmp_path, commands)


def test_all_runs_failed(frame: pd.DataFrame, tmp_path: Path) -> None:
    lost = frame.copy()
    lost["status"], lost["peak"], lost["reason"] = "failed", np.nan, "The worker was killed."
    text = report_of(lost, tmp_path, commands)[0].read_text(encoding="utf-8")
    assert "No run yields a measure." in text
    assert "The worker was killed." in text


def test_round_off_is_no_effect(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    peaks = 3.0 * (1.0 + 1e-15 * rng.integers(-2, 3, 100))
    frame = frame_of({"mass": np.arange(100.0)}, {"peak": peaks}, UNITS)
    data = study_data(frame)
    assert np.isnan(rank_correlations(data, data.responses)).all()
    assert "It is 3 m/s² in all runs" in report_of(frame, tmp_path, commands)[0].read_text(encoding="utf-8")
    frame["peak"] = 3.0 * (1.0 + 1e-6 * rng.random(100))
    assert study_data(frame).responses[0].varies


def test_a_parameter_that_changes_round_off_only_has_no_effect() -> None:
    """Beside one that does; and a lateral acceleration of a car that drives straight is none."""
    a, b = (g.ravel() for g in np.meshgrid([0.0, 1.0, 2.0], [0.0, 1.0, 2.0], indexing="ij"))
    columns = {"peak": 3.0 + a + 2e-9 * b, "straight": 5e-11 * (1.0 + a)}
    frame = frame_of({"mass": a, "toe": b}, columns, UNITS | {"straight": "m/s2"}, method="grid")
    data = study_data(frame)
    assert [r.varies for r in data.responses] == [True, False]
    assert rank_correlations(data, data.responses)[0] == pytest.approx([1.0, 0.0], abs=1e-12)
    indices = indices_of(data, data.responses[0])
    assert isinstance(indices, Indices)
    assert (indices.first[1], indices.total[1]) == (0.0, 0.0)


def test_units_are_those_of_the_field() -> None:
    x = np.linspace(0.1, 0.2, 20)
    frame = frame_of({"toe": x}, {"roll": 2.0 * x}, {"toe": "rad", "roll": "rad"})
    frame.attrs["limits"] = {"roll": {"min": None, "max": np.pi / 10, "unit": "rad"}}
    data = study_data(frame)
    assert (data.parameters[0].unit, data.responses[0].unit) == ("deg", "deg")
    assert data.x[:, 0] == pytest.approx(np.degrees(x))
    assert data.responses[0].values == pytest.approx(np.degrees(2.0 * x))
    assert data.responses[0].limits == pytest.approx((-np.inf, 18.0))


@pytest.mark.parametrize(
    ("method", "count", "title"),
    [
        ("grid", 2, "Values (2 runs of a grid, not a random sample)"),
        ("table", 40, "Values (40 runs of a table, not a random sample)"),
        ("sobol", 19, "Values (19 runs; a distribution needs 20)"),
        ("sobol", 20, "Distribution"),
    ],
)
def test_a_distribution_is_drawn_of_a_random_sample_only(method: str, count: int, title: str) -> None:
    x = np.linspace(1.0, 2.0, count)
    data = study_data(frame_of({"mass": x}, {"peak": x[::-1]}, UNITS, method=method))
    figure, axes = plt.subplots()
    plot_distribution(axes, data, data.responses[0])
    assert axes.get_title() == title
    assert bool(axes.patches) == (title == "Distribution")
    if not axes.patches:
        assert axes.lines[0].get_xdata() == pytest.approx(x)
    plt.close(figure)


def test_one_parameter_has_no_indices_and_a_grid_no_percentiles() -> None:
    """Of one parameter an index is 1 whatever the model does."""
    data = study_data(frame_of({"mass": [1.0, 2.0]}, {"peak": np.array([3.0, 4.0])}, UNITS, method="grid"))
    indices = indices_of(data, data.responses[0])
    assert indices == "No indices: mass alone is varied and makes all of the variance."


@pytest.mark.parametrize("method", ["grid", "latin_hypercube"])
def test_the_table_of_measures_has_percentiles_of_random_samples_alone(method: str) -> None:
    """A grid has no probabilities: its quarters lie where somebody put its values."""
    x = np.linspace(0.0, 1.0, 20)
    section = measures_section(study_data(frame_of({"mass": x}, {"peak": x}, UNITS, method=method)))
    text = " ".join(" ".join(part.itertext()) for part in section.parts if not isinstance(part, str))
    assert section.title == "Measures"
    assert [name in text for name in ("5 %", "95 %", "mean", "std")] == 4 * [method != "grid"]
    assert ("There are no percentiles: 20 runs of a grid, not a random sample." in text) == (method == "grid")
    assert all(name in text for name in ("lowest", "median", "highest"))


def test_indices_that_are_noise_are_hollow_points() -> None:
    none = np.full(2, np.nan)
    indices = Indices(("a", "b"), np.array([0.9, -0.02]), np.array([0.05, 0.03]), none, none, "")
    figure, axes = plt.subplots()
    plot_indices(axes, indices)
    assert not axes.patches  # no bars
    points = {str(c.get_label()): c.lines[0] for c in axes.containers}
    assert points["first order"].get_xdata().tolist() == [0.9]
    assert points["first order, may be 0"].get_xdata().tolist() == [-0.02]
    assert points["first order, may be 0"].get_markerfacecolor() == "white"
    plt.close(figure)


def test_where_runs_fail(frame: pd.DataFrame) -> None:
    data = study_data(frame)
    result = failed_share(data.x[:, 0], data.failed)
    at, share, low, high = result.at, result.mean, result.low, result.high
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
    assert runs == frame.index[frame["status"] == "failed"].tolist()
    assert reason == f"The FMU refused the step at {0.1 * runs[0]:g} to {0.1 * runs[-1]:g} s."
    assert statistics(peak)["5 %"] == pytest.approx(frame["peak"].quantile(0.05))


def test_two_manoeuvres_are_two_responses() -> None:
    x = np.linspace(1.0, 2.0, 50)
    frame = frame_of({"mass": x}, {"peak": np.stack([x, -x], axis=1).ravel()}, UNITS, manoeuvres=("slalom", "drop"))
    data = study_data(frame)
    assert [r.label for r in data.responses] == ["peak (slalom)", "peak (drop)"]
    assert data.responses[1].values == pytest.approx(-x)
    assert data.points(data.responses[1]).tolist() == list(range(50))
    assert rank_correlations(data, data.responses).ravel().tolist() == pytest.approx([1.0, -1.0])
