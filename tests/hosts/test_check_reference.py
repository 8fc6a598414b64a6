"""`ali3 check FMU --reference FILE`: agreement, deviations, and tables that are no reference."""

import csv
import math
import shutil
from collections.abc import Callable, Generator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hosts.check.command import main
from hosts.check.deviations import deviations
from hosts.check.reference import in_order
from hosts.driving.result import Result
from hosts.driving.runs_with_progress import runs_with_bar
from hosts.run.command import main as run_main
from tests.in_process import run


@pytest.fixture(scope="module")
def fmu(tuned: Path) -> Path:
    return tuned


@pytest.fixture(scope="module")
def ran(fmu: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run with a jump and a tunable parameter that changes, and its record."""
    folder = tmp_path_factory.mktemp("ran")
    table = folder / "given.csv"
    table.write_text('"time","pull","spring.damping"\n0,0,1\n0.4,30,1\n0.4,-20,5\n1,0,2\n')
    assert run(run_main, fmu, "-m", table, "--step", 0.01, "--out", folder).returncode == 0
    return folder


@pytest.fixture
def result(ran: Path, tmp_path: Path) -> Path:
    """A copy of the run that the test may change."""
    shutil.copytree(ran, tmp_path, dirs_exist_ok=True)
    return tmp_path / "tuned_given.csv"


def changed(file: Path, change: Callable[[list[str], list[list[str]]], None]) -> Path:
    """The table with its record, but changed."""
    heading, *rows = csv.reader(file.read_text().splitlines())
    change(heading, rows)
    file.write_text("\n".join(",".join(row) for row in [heading, *rows]) + "\n")
    return file


def test_a_result_is_a_reference_of_its_own_fmu(fmu, result):
    done = run(main, fmu, "--reference", result, "--bound", "*=1e-6")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "all within their bounds" in done.stdout
    assert "BAD" not in done.stdout


@pytest.mark.parametrize(("error", "bound", "code"), [(0.005, None, 0), (0.005, 0.001, 1)])
def test_a_signal_beyond_its_bound_is_named(error, bound, code, fmu, result):
    def change(heading: list[str], rows: list[list[str]]) -> None:
        k = heading.index("bob.y")
        y = [float(row[k]) for row in rows]
        rows[70][k] = repr(float(y[70] + error * np.ptp(y)))

    table = changed(result, change)
    bounds = ("--bound", "*=0.001", "--bound", f"bob.y={bound or 0.01}")
    done = run(main, fmu, "--reference", table, *bounds)
    assert done.returncode == code, done.stdout + done.stderr
    line = next(line for line in done.stdout.splitlines() if "bob.y" in line)
    assert line.startswith("BAD" if code else " ok")
    assert "at" in done.stdout
    assert ("1 beyond their bounds" in done.stdout) == bool(code)


def test_what_drives_it_in_place_of_the_table_does_so_at_the_step_of_the_table(fmu, tmp_path):
    """Rows are every 0.1 s, the step of their run was neither that nor the FMU's."""
    table = tmp_path / "given.csv"
    table.write_text('"time","pull"\n0,0\n0.4,30\n1,0\n')
    assert run(run_main, fmu, "-m", table, "--step", 0.02, "--interval", 0.1, "--out", tmp_path).returncode == 0
    done = run(main, fmu, "-m", table, "--reference", tmp_path / "tuned_given.csv", "--bound", "*=1e-6")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "in steps of 0.02 s" in done.stdout


@pytest.mark.slow
def test_a_stopped_check_of_a_folder_resumes_with_the_other_tables(fmu, result, tmp_path, monkeypatch):
    folder = tmp_path / "tables"
    folder.mkdir()
    for name in "abc":
        for suffix in (".csv", ".json"):
            shutil.copyfile(result.with_suffix(suffix), folder / f"{name}{suffix}")
    command = main, fmu, "--reference", folder, "--out", tmp_path / "out", "--jobs", 1
    driven = list[int]()

    def stopped(fmu: object, drives: Sequence[object], jobs: int) -> Generator[object]:
        driven.append(len(drives))
        for result in runs_with_bar(fmu, drives, jobs):  # type: ignore[arg-type]
            yield result
            if len(driven) == 1:
                raise KeyboardInterrupt

    monkeypatch.setattr("hosts.check.reference.runs_with_bar", stopped)
    assert run(*command).returncode == 130
    done = run(*command)
    assert (done.returncode, driven) == (0, [3, 2])
    assert done.stdout.startswith("1 of 3 tables are there; --again repeats them.\n")
    output = [line for line in done.stdout.splitlines() if " against " in line]
    assert [Path(line.split(" against ")[1].split(", ")[0]).name for line in output] == ["a.csv", "b.csv", "c.csv"]
    assert "are there" not in run(*command).stdout  # a check that reached its end is made anew
    assert driven == [3, 2, 3]


@pytest.mark.parametrize("given", [("--again",), ("--out", "kept")])
def test_of_one_table_nothing_is_kept(fmu, result, given):
    done = run(main, fmu, "--reference", result, *given)
    assert (done.returncode, done.stdout) == (2, "")
    assert f"{given[0]} needs a folder of tables" in done.stderr
    assert f"{result} is a single table." in done.stderr


def test_tables_are_reported_in_their_order_whichever_is_done_first():
    tables = in_order(iter([(2, "c"), (0, "a"), (1, "b"), (3, "d")]))
    assert [next(tables), *tables] == ["a", "b", "c", "d"]


def test_a_jump_inside_a_step_is_reported(fmu, tmp_path):
    table, reference = tmp_path / "given.csv", tmp_path / "reference.csv"
    table.write_text('"time","pull"\n0,0\n0.4,20\n0.4,10\n0.404,30\n0.404,-20\n1,0\n')
    reference.write_text('"time","bob.x"\n0,0\n1,0\n')
    output = run(main, fmu, "--reference", reference, "-m", table, "--step", 0.01).stdout
    assert output.count("jumps inside a communication step: 1 of pull, the first at 0.404 s") == 1


@pytest.mark.parametrize(
    ("what", "messages"),
    [
        (
            {"bob.x": lambda x: 1000.0 * x, "bob.y": lambda y: -y},
            (
                "bob.x: in agreement where the table has it 1000 times as large: mm instead of m?",
                "bob.y: in agreement where the table has it with the other sign",
            ),
        ),
        ({"bob.y": lambda y: np.r_[y[0], y[:-1]]}, ("where the table has it 0.01 s later, by one row",)),
        ({"bob.y": lambda y: np.r_[y[1:], y[-1]]}, ("where the table has it 0.01 s earlier, by one row",)),
        (
            {"bob.x": lambda x: 0.0 * x, "bob.y": lambda y: y + 0.2},
            ("off since the first row: bob.y; does the FMU start", "0 m, taken as 0.0001"),
        ),
    ],
)
def test_a_change_that_would_make_signals_agree_is_reported(what, messages, fmu, result):
    def change(heading: list[str], rows: list[list[str]]) -> None:
        for name, of in what.items():
            k = heading.index(name)
            for row, value in zip(rows, of(np.array([float(row[k]) for row in rows])), strict=True):
                row[k] = repr(float(value))

    done = run(main, fmu, "--reference", changed(result, change), "--bound", "bob.y=1e-5")
    assert done.returncode == 1
    assert [message for message in messages if message not in done.stdout] == [], done.stdout


def test_inputs_without_a_column_and_rows_far_apart_are_reported(fmu, tmp_path):
    (tmp_path / "few.csv").write_text('"time","pull","bob.x"\n0,0,0\n0.5,20,0\n1,0,0\n')
    (tmp_path / "none.csv").write_text('"time","bob.x"\n0,0\n0.5,0\n1,0\n')
    few, none = (run(main, fmu, "--reference", tmp_path / f"{name}.csv").stdout for name in ("few", "none"))
    assert "the bound is 1 % of the range of each" in few
    assert "between rows, up to 0.5 s apart, inputs go straight" in few
    assert "inputs without a column, which keep their start values: pull" in none
    assert "inputs without" not in few
    assert "inputs go straight" not in none


def test_an_angle_is_off_by_its_share_of_a_turn_where_whole_turns_are_left_out():
    """Over many turns half of one is less than a hundredth, so that nothing would be beyond it."""
    time = np.linspace(0.0, 1.0, 101)
    angle = 600.0 * time
    for gap, share in ((3.0, 3.0 / 600.0), (100.0, (100.0 % math.tau) / math.tau), (4.0 * math.tau, 0.0)):
        result = Result(["turned"], {"turned": "rad"}, time, (angle + gap)[:, None], 0.0, 1.0, 0, [])
        (found,) = deviations({"turned": 1.0}, result, time, {"turned": angle})
        assert found.share == pytest.approx(min(share, gap / 600.0, 1.0 - share), abs=1e-9)


def test_bounds_of_0_ask_for_the_same_bits(fmu, result):
    def change(heading: list[str], rows: list[list[str]]) -> None:
        rows[3][heading.index("bob.y")] = "7"

    done = run(main, fmu, "--reference", changed(result, change), "--bound", "*=1e-6", "--bound", "bob.?=0")
    assert done.returncode == 1
    assert done.stdout.splitlines()[1].startswith("BAD   bob.")
    for share in ("nan", "-1"):
        done = run(main, fmu, "--reference", result, "--bound", f"bob.y={share}")
        assert done.returncode == 2
        assert f"bob.y is {share}; it must be a share of the range, 0 or more" in done.stderr


def test_a_table_of_one_row_that_begins_later_is_compared_from_there(fmu, tmp_path):
    (tmp_path / "table.csv").write_text('"time","pull","bob.x"\n1,2,9\n')
    done = run(main, fmu, "--reference", tmp_path / "table.csv", "--step", 0.01)
    assert done.returncode == 1
    assert "1 beyond their bounds" in done.stdout
    assert "table.csv begins at 1 s and is compared from there\n" in done.stdout
    assert "begin of the table: at 1 s; before, its first row holds pull at 2\n" in done.stdout


def test_variables_that_the_fmu_lacks_are_reported(fmu, result):
    def change(heading: list[str], rows: list[list[str]]) -> None:
        heading[heading.index("bob.y")] = "bob.height"

    done = run(main, fmu, "--reference", changed(result, change), "--bound", "bob.x=1e-6")
    assert done.returncode == 0
    assert "not compared, for Tuned.fmu has no such output: bob.height" in done.stdout


@pytest.mark.parametrize(
    ("table", "options", "message"),
    [
        ('"time","pull"\n0,0\n1,1\n', (), "no column that is an output"),
        ('"time","bob.x"\n0,0\n', (), "a reference must end after 0 s"),
        ('"time","bob.x"\n0,0\n0.013,0\n0.02,0\n', ("--step", 0.01), "a row at 0.013 s, which is not a communication"),
        ('"time","bob.x"\n-2,0\n1,0\n', (), "begins at -2 s; a run begins at 0: add 2 s to all its times"),
        ('"time","bob.x"\n0,0\n1,0\n', ("--bound", "bob.z=1"), "--bound bob.z:"),
        ('"time","bob.x"\n0,0\n1,0\n', ("--show-parameters",), "--show-parameters cannot be combined with --reference"),
    ],
)
def test_an_invalid_reference_is_refused_in_one_sentence(table, options, message, fmu, tmp_path):
    (tmp_path / "table.csv").write_text(table)
    done = run(main, fmu, "--reference", tmp_path / "table.csv", *options)
    assert done.returncode == 2
    assert message in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_the_free_swing_is_that_of_a_pendulum_on_a_spring(fmu, tmp_path):
    """A reference from elsewhere: the equation of motion in polar coordinates, by an integrator of SciPy."""
    mass, k, c, free, g = 2.0, 100.0, 1.0, 0.8, 9.81

    def rates(t: float, y: list[float]) -> list[float]:
        r, phi, v, w = y
        pull = 10.0 * t
        along = pull * math.sin(phi) + mass * g * math.cos(phi) - k * (r - free) - c * v
        across = pull * math.cos(phi) - mass * g * math.sin(phi)
        return [v, w, r * w**2 + along / mass, (across / mass - 2.0 * v * w) / r]

    t = np.linspace(0.0, 2.0, 41)
    solver: Any = solve_ivp
    r, phi = solver(rates, (0.0, 2.0), [1.0, 0.0, 0.0, 0.0], "DOP853", t, rtol=1e-11, atol=1e-12).y[:2]
    columns = (t, 10.0 * t, r * np.sin(phi), -r * np.cos(phi))
    rows = "\n".join(",".join(map(repr, row)) for row in zip(*(c.tolist() for c in columns), strict=True))
    (tmp_path / "swing.csv").write_text(f'"time","pull","bob.x","bob.y"\n{rows}\n')
    fine = ("--step", 0.01, "--set", "step_size=0.001", "--bound", "*=1e-5")
    done = run(main, fmu, "--reference", tmp_path / "swing.csv", *fine)
    assert done.returncode == 0, done.stdout + done.stderr
