"""Every test of the catalogue is a manoeuvre of a study, and its row is whole."""

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from hosts.catalogue.registry import TESTS
from hosts.study.command import main
from hosts.study.plan import make_plan
from hosts.study.study_file import read_study_file
from hosts.study.study_runs import Bench
from hosts.study.trial_runs import make_trial_runs, with_columns
from hosts.study.worker_data import DONE, Outcome

STUDY = 'fmu = "{fmu}"\nstep = 0.005\n[parameters]\n"front.tyre.grip" = {{ values = [1.0, 0.9] }}\n'
# Short, and such that nothing is asked that these runs cannot tell.
SHORT = {
    "steady_circle": "speed_rise = 1.0, fit_to = 3.0, radius = 30.0",
    "step_steer": "level_2 = 0.0, level_3 = 0.0",
    "chirp_steer": "duration = 40.0",
    "sine_with_dwell": "increment = 5.0",
    "double_lane_change": "course = 2.0, lowest = 60.0, increment = 20.0, resolution = 10.0",
    "straight_braking": "speed = 30.0",
    "braking_in_a_turn": "levels = 2.0, pedal = 0.5, radius = 40.0, deceleration = 4.0",
    "power_off_in_a_turn": "levels = 2.0, lowest = 4.0, highest = 5.2",
    "drop": "height = 0.1, duration = 4.0",
}


@pytest.fixture
def study(prototype_fmu: Path, tmp_path: Path) -> Callable[[str], Path]:
    def write(more: str) -> Path:
        (tmp_path / "study.toml").write_text(STUDY.format(fmu=prototype_fmu) + more)
        return tmp_path / "study.toml"

    return write


def entry(test: str, more: str = "") -> str:
    return f'[[manoeuvres]]\ntest = "{test}"\nsettings = {{ {SHORT.get(test, "")} }}\n{more}\n'


@pytest.mark.slow
def test_each_test_gives_a_whole_row(study: Callable[[str], Path], prototype_fmu: Path) -> None:
    file = study("".join(entry(test) for test in TESTS))
    plan = make_plan(read_study_file(file)[0], file, prototype_fmu)
    bench = Bench(plan.work, prototype_fmu)
    ended: dict[str, Outcome] = {job.test: bench.run(job, {"front.tyre.grip": 1.0}, 0) for job in plan.work.jobs}
    assert {test: (o.status, o.reason) for test, o in ended.items()} == dict.fromkeys(TESTS, (DONE, ""))
    for test, outcome in ended.items():
        assert len(outcome.units) > 5
        assert {name.partition(".")[0] for name in outcome.measures} == {test}
    circle = ended["steady_circle"].measures
    speeds = [circle[f"steady_circle.{name}_speed"] for name in ("characteristic", "critical")]
    assert sorted(map(math.isfinite, speeds)) == [False, True]


@pytest.mark.usefixtures("in_process")
def test_measures_that_are_chosen_are_the_columns(study: Callable[[str], Path], prototype_fmu: Path) -> None:
    file = study(entry("drop", 'measures = ["settling_time", "load.peak"]'))
    plan = make_plan(read_study_file(file)[0], file, prototype_fmu)
    trial = make_trial_runs(plan)
    assert (trial.columns, trial.notes) == ({"drop.load.peak": "N", "drop.settling_time": "s"}, ())
    outcome = Bench(with_columns(plan, trial.columns).work, prototype_fmu).run(plan.work.jobs[0], {}, 0)
    assert sorted(outcome.measures) == sorted(trial.columns)


@pytest.mark.usefixtures("in_process")
def test_an_unknown_measure_is_one_sentence(
    study: Callable[[str], Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = study(entry("drop", 'measures = ["load.peek"]'))
    assert main([str(file), "--out", str(tmp_path / "out")]) == 2
    assert capsys.readouterr().err.replace(f"{tmp_path}/", "") == (
        "error: study.toml: manoeuvres[1].measures: the test drop has no measure 'load.peek'; did you mean 'load.peak' "
        "or 'load.peak_RR' or 'load.peak_RL'?\n"
    )
    assert not (tmp_path / "out" / "study.json").exists()
