"""The command from a log to its files, and its messages on faulty logs and options."""

import json
import math
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest

from hosts.compare.command import _names, main
from hosts.view.result_tables import read_table
from tests.hosts.compare.pendulum import measured, measured_pull, motion

SCENES = Path(__file__).parents[1] / "scenes.py"
TRUE = (123.0, 1.7)
Columns = dict[str, np.ndarray]


def log_columns(delay: float = 0.0) -> Columns:
    signals = measured(motion(*TRUE), 1, 0.0, delay)
    t = signals["bob.x"].time
    pull = measured_pull()
    return {"time": t, "pull": np.interp(t, pull.time, pull.values), **{n: s.values for n, s in signals.items()}}


def write(file: Path, columns: Columns) -> Path:
    lines = [",".join(columns)]
    for row in np.column_stack(list(columns.values())):
        lines.append(",".join("" if math.isnan(v) else repr(float(v)) for v in row))
    file.write_text("\n".join(lines) + "\n")
    return file


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write(tmp_path_factory.mktemp("log") / "drive.csv", log_columns())


@pytest.mark.usefixtures("in_process")
class TestCommand:
    @pytest.mark.slow
    def test_a_fit_that_is_stopped_leaves_the_comparison(self, tuned, log, tmp_path, capsys, monkeypatch):
        def stopped(
            outputs: object, unknowns: object, simulate: Callable[[Mapping[str, float]], object], **more: object
        ) -> None:
            simulate({"spring.stiffness": 120.0})
            raise KeyboardInterrupt

        monkeypatch.setattr("hosts.compare.fitting.fit", stopped)
        assert main([str(tuned), str(log), "--out", str(tmp_path), "--fit", "spring.stiffness"]) == 130
        captured = capsys.readouterr()
        assert captured.err.endswith("stopped by Ctrl-C\n")
        assert "drive.html" in captured.out
        assert "drive.ssv" not in captured.out
        assert "The fit was stopped after " in (tmp_path / "drive.html").read_text()
        assert not (tmp_path / "drive.ssv").exists()

    def test_a_value_that_is_set_keeps_its_size_under_another_name(self, tuned, log, tmp_path):
        (tmp_path / "names.toml").write_text('rate = { name = "spring.stiffness", factor = 1000.0 }\n')
        results = []
        for k, more in enumerate(([], ["--aliases", str(tmp_path / "names.toml")])):
            record = tmp_path / f"{k}.json"
            options = ["--out", str(tmp_path), "--json", str(record), "--set", "spring.stiffness=130", *more]
            main([str(tuned), str(log), *options])
            results.append(json.loads(record.read_text())["measures"])
        assert results[0] == results[1]

    @pytest.mark.slow
    def test_an_fmu_of_fmi_3_is_fitted_too(self, scene_fmu, log, tmp_path):
        fmu, record = scene_fmu(f"{SCENES}:tuned", "fmi3"), tmp_path / "record.json"
        fits = ["--fit", "spring.stiffness", "--fit", "spring.damping=0.2:5"]
        assert main([str(fmu), str(log), "--out", str(tmp_path), "--json", str(record), *fits]) == 0
        found = {f["name"]: f["value"] for f in json.loads(record.read_text())["fit"]["found"]}
        for name, true in zip(("spring.stiffness", "spring.damping"), TRUE, strict=True):
            assert found[name] == pytest.approx(true, rel=0.03)

    @pytest.mark.slow
    @pytest.mark.drawn
    def test_compare_and_fit(self, tuned, log, tmp_path, capsys):
        arguments = [str(tuned), str(log), "--out", str(tmp_path), "--json", str(tmp_path / "all.json")]
        assert (
            main([*arguments, "--fit", "spring.stiffness", "--fit", "spring.damping=0.2:5", "--nuisance", "bias"]) == 0
        )
        output = capsys.readouterr().out
        assert "residuals over noise" in output
        record = json.loads((tmp_path / "all.json").read_text())
        results = {f["name"]: f for f in record["fit"]["found"]}
        for name, true in zip(("spring.stiffness", "spring.damping"), TRUE, strict=True):
            assert abs(results[name]["value"] - true) < 1.5 * results[name]["half_width_95"]
        rms = {m["name"]: m["value"] for m in record["fitted_measures"]}
        assert rms["bob.x.rms"] == pytest.approx(0.01, rel=0.15)  # the noise, and nothing else
        assert rms["bob.y.rms"] == pytest.approx(0.005, rel=0.15)
        table = read_table(tmp_path / "drive.csv")
        assert table.units["bob.x.fitted"] == "m"
        assert np.std(table.columns["bob.x.fitted"] - table.columns["bob.x.measured"]) == pytest.approx(0.01, rel=0.15)
        page = (tmp_path / "drive.html").read_text()
        assert "spring.stiffness" in page
        assert "<p>Left of parts of the log that are left out in turn, to first order: bob.x " in page
        assert "data:image/svg+xml;base64" in page
        assert (tmp_path / "drive.ssv").is_file()
        # The parameter set gives the fitted run without a fit.
        assert main([*arguments, "--parameters", str(tmp_path / "drive.ssv")]) == 0
        again = {m["name"]: m["value"] for m in json.loads((tmp_path / "all.json").read_text())["measures"]}
        assert again["bob.x.rms"] == pytest.approx(0.01, rel=0.15)

    @pytest.mark.slow
    def test_starts_intervals_and_folds_of_a_log_of_another_engine(self, tuned, tmp_path, capsys):
        """Every start finds the numbers of SciPy's pendulum within the intervals; so do folds, until they change."""
        fit = ("--fit", "spring.stiffness=60:200,spring.damping=0.3:4", "--starts")

        def fitted(
            columns: Columns, count: str
        ) -> tuple[dict[str, dict[str, float | list[float]]], list[dict[str, list[float]]]]:
            file = write(tmp_path / "drive.csv", columns)
            main([str(tuned), str(file), "--out", str(tmp_path), "--json", str(tmp_path / "all.json"), *fit, count])
            record = json.loads((tmp_path / "all.json").read_text())["fit"]
            return {f["name"]: f for f in record["found"]}, record["starts"]

        columns = log_columns()
        result, starts = fitted(columns, "3")
        assert "without a fold" in capsys.readouterr().out
        assert len(starts) == 3
        for name, true in zip(("spring.stiffness", "spring.damping"), TRUE, strict=True):
            value, half, folds = (result[name][k] for k in ("value", "half_width_95", "folds"))
            assert abs(value - true) < half
            assert len(folds) == 4
            assert all(abs(fold - true) < 2.0 * half for fold in folds)
            k = list(result).index(name)
            assert all(start["end"][k] == pytest.approx(value, abs=0.2 * half) for start in starts)
        assert len({start["begin"][0] for start in starts}) == 3
        late, moved = columns["time"] > 3.0, motion(1.15 * TRUE[0], TRUE[1])(columns["time"])
        changed = {
            f"bob.{c}": np.where(late, values, columns[f"bob.{c}"]) for c, values in zip("xy", moved, strict=True)
        }
        other, _ = fitted(columns | changed, "1")
        before, after = (np.ptp(f["spring.stiffness"]["folds"]) for f in (result, other))
        assert after > 5.0 * before  # what the seconds do not agree on is seen
        assert other["spring.stiffness"]["half_width_95"] > 3.0 * result["spring.stiffness"]["half_width_95"]

    @pytest.mark.slow
    @pytest.mark.parametrize(
        ("factor", "messages"),
        [
            (1000.0, ['it looks like mm instead of m: unit = "mm"']),
            (-1.0, ["has the opposite sign", "Or the input 'pull' (pull) has the opposite sign"]),
            (1.0 / 9.81, ["in the simulation: is it in another unit"]),
        ],
    )
    def test_a_wrong_unit_is_seen_and_nothing_is_fitted(self, tuned, tmp_path, capsys, factor, messages):
        columns = log_columns()
        file = write(tmp_path / "odd.csv", columns | {"bob.x": factor * columns["bob.x"]})
        common = [str(tuned), str(file), "--out", str(tmp_path / "out"), "--set", "spring.stiffness=120"]
        assert main([*common, "--fit", "spring.stiffness"]) == 2
        assert "Nothing was fitted" in capsys.readouterr().err
        assert main(common) == 1
        output = capsys.readouterr().out
        assert all(message in output for message in messages)

    def test_a_constant_signal_beside_a_log_that_is_not_written_over(self, tuned, tmp_path, capsys):
        columns = log_columns()
        file = write(tmp_path / "flat.csv", columns | {"bob.y": 0.0 * columns["bob.y"] - 1.0})
        before = file.read_bytes()
        main([str(tuned), str(file), "--out", str(tmp_path)])
        assert "bob.y: the measured signal is constant: no correlation" in capsys.readouterr().out
        assert file.read_bytes() == before
        assert (tmp_path / "flat_compared.csv").is_file()

    @pytest.mark.parametrize(
        ("options", "message"),
        [
            (["--signals", "bob.z"], "--signals: 'bob.z' is not an output of the FMU; did you mean"),
            (["--signals", "solver.status"], "'solver.status' is not in the log"),
            (["--fit", "spring.stifness"], "the FMU has no parameter 'spring.stifness'; did you mean 'spring.st"),
            (["--fit", "spring.stiffness=200:100"], "the first must be the smaller"),
            (["--fit", "spring.stiffness=1:500"], "the range of the FMU is"),
            (["--fit", "spring.stiffness=150:500"], "begins at 100 N/m, which is not between 150 and 500"),
            (["--fit", "spring.stiffness=a:b"], "'a' is not a number"),
            (["--nuisance", "delay"], "--nuisance needs --fit"),
            (["--fit", "spring.damping", "--nuisance", "lag"], "'lag' is not known"),
            (["--from", "20"], "--from is 20 s; the log's inputs lie between 0 and"),
            (["--skip", "7"], "--skip is 7 s; the log lasts"),
            (["--ignore", "pull"], "there is nothing to replay"),
            (["--ignore", "pusch"], "'pusch' is not an input in the log; it has pull"),
            (["--fit", "solver.step_iterations=0:9"], "only real numbers can be fitted"),
            (["--fit", "spring.damping", "--fit", "spring.damping"], "is given twice"),
        ],
    )
    def test_wrong_wishes(self, tuned, log, tmp_path, capsys, options, message):
        assert main([str(tuned), str(log), "--out", str(tmp_path), *options]) == 2
        errors = capsys.readouterr().err
        assert message in errors
        assert errors.count("\n") == 1
        assert not list(tmp_path.iterdir())

    def test_a_gap_in_an_input(self, tuned, tmp_path, capsys):
        columns = log_columns()
        hole = (columns["time"] > 2.0) & (columns["time"] < 3.0)
        file = write(tmp_path / "gap.csv", columns | {"pull": np.where(hole, np.nan, columns["pull"])})
        assert main([str(tuned), str(file), "--out", str(tmp_path)]) == 2
        errors = capsys.readouterr().err
        assert "no samples of the input 'pull' (pull) from 2 s to 3 s (1 s; usual are 0.02 s)" in errors
        assert "--to 2" in errors
        assert main([str(tuned), str(file), "--out", str(tmp_path), "--longest-gap", "1.01"]) == 0
        assert "is bridged by a straight line" in capsys.readouterr().out

    def test_an_input_beyond_its_range(self, tuned, tmp_path, capsys):
        columns = log_columns()
        file = write(tmp_path / "far.csv", columns | {"pull": 100.0 * columns["pull"]})
        assert main([str(tuned), str(file), "--out", str(tmp_path)]) == 2
        assert "the range of the FMU's input is -50 to 50 N" in capsys.readouterr().err

    @pytest.mark.slow
    def test_parameters_that_the_log_does_not_tell(self, tuned, tmp_path, capsys):
        file = write(tmp_path / "few.csv", log_columns())
        common = [str(tuned), str(file), "--out", str(tmp_path / "out"), "--signals", "bob.x"]
        # True is 123: the best within this range is at its end.
        assert main([*common, "--fit", "spring.stiffness=90:110"]) == 1
        assert "lies at its upper bound, 110 N/m" in capsys.readouterr().out
        assert main([*common, "--fit", "step_size=0.01:0.012"]) == 2
        assert "does not change any of the compared signals" in capsys.readouterr().err


def test_commas_part_names_but_not_the_places_of_an_array():
    assert _names("a.b=1:2,c[1,2]=0.5:3,d") == ["a.b=1:2", "c[1,2]=0.5:3", "d"]
