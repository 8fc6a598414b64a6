"""The commands that draw the charts run in their reduced form, and what they compute from rows is right."""

import dataclasses
import json

import numpy as np
import pytest

from benchmarks import cost, honesty, stability, work_precision
from benchmarks.baselines.run import METHODS as CLASSICAL
from benchmarks.methods import cost_growth, dissipative
from benchmarks.methods import stability as maps
from benchmarks.methods import work_precision as precision
from benchmarks.methods.honesty import honesty_blocks, summary
from benchmarks.methods.kernel_methods import TITLES, TREE_ONLY
from benchmarks.methods.random_honesty import verdict_of
from benchmarks.methods.stability import OUTCOMES
from benchmarks.methods.stability_margins import margins
from benchmarks.methods.work_precision import time_at_error, work_blocks
from benchmarks.paper import __main__ as paper
from benchmarks.references.cases import CASES
from mbs import Settings
from mbs.settings.settings import METHODS as KERNEL

PNG = b"\x89PNG"


def read(file):
    data = json.loads(file.read_text(encoding="utf-8"))
    assert data["meta"]["machine"]["python"]
    assert data["rows"]
    return data["meta"], data["rows"]


@pytest.mark.slow
def test_work_precision_runs_every_method_and_one_gets_better_with_the_step(tmp_path, capsys, monkeypatch):
    coarse = dataclasses.replace(CASES["double_four_bar"], divisions=(1, 1, 1, 2, 4))
    monkeypatch.setitem(CASES, "double_four_bar", coarse)
    monkeypatch.setattr(precision, "LONG", 0.02)  # s; longer ones are not repeated
    monkeypatch.setattr(precision, "FEW_REPEATS", 0)
    files = ["--json", str(tmp_path / "w.json"), "--chart", str(tmp_path)]
    assert work_precision.main(["charts", "--quick", "--only", "double_four_bar", *files]) == 0
    _, rows = read(tmp_path / "w.json")
    assert {"kernel", "classical"} <= {r["family"] for r in rows}
    assert set(CLASSICAL) <= {r["method"] for r in rows}
    lagrange = sorted((r["h_s"], r["position_error_m"]) for r in rows if r["method"] == "index-1 Lagrange, Baumgarte")
    assert lagrange[0][1] < 0.5 * lagrange[-1][1]
    blocks = work_blocks(rows)
    assert all(f"| double_four_bar | {method} |" in blocks["times"] for method in {r["method"] for r in rows})
    refused = [r for r in rows if r["ended"].startswith("refused")]
    assert any(r["method"] == "velocity transformation" for r in refused)
    assert (tmp_path / "work_double_four_bar.png").read_bytes().startswith(PNG)
    assert "Behind the best peer in" in capsys.readouterr().out


@pytest.mark.slow
def test_stability_maps_judge_every_method_and_explain_refusals(tmp_path, capsys):
    files = ["--json", str(tmp_path / "s.json"), "--chart", str(tmp_path)]
    assert stability.main(["--quick", "--only", "double_four_bar", *files]) == 0
    _, rows = read(tmp_path / "s.json")
    assert {r["outcome"] for r in rows} <= set(OUTCOMES)
    assert len({r["method"] for r in rows}) == len(KERNEL) + len(CLASSICAL)
    fixed = [r for r in rows if r["method"] == "velocity transformation"]
    assert fixed
    assert all(r["outcome"] == "refused" and r["reason"] for r in fixed)
    by_method = {m["method"]: m for m in margins(rows)}
    bare = TITLES["ali3p_no_projection"]  # at no step, over the whole motion
    assert {name for name, m in by_method.items() if m["largest_fine_h_s"] is None} == {bare}
    assert by_method[TITLES["ali3p"]]["first_break"] == "wrong at 0.02 s"
    without = {TITLES[m] for m in TREE_ONLY} | {bare}
    assert {name for name, m in by_method.items() if m["decades_below"] is None} == without
    lagrange = [r for r in rows if r["method"] == "index-1 Lagrange, Baumgarte"]
    assert [r["outcome"] for r in lagrange] == ["fine", "wrong"]  # 10 1/s; 0.02 and 0.05 s
    blocks = maps.stability_blocks(rows)
    assert all(f"| {title} |" in blocks["margins"] for title in by_method)
    assert (tmp_path / "stability_double_four_bar.png").read_bytes().startswith(PNG)
    assert "dead point" in capsys.readouterr().out


@pytest.mark.slow
def test_the_default_is_right_on_the_spinning_beam_and_the_standing_car(tmp_path, capsys):
    assert work_precision.main(["dissipative", "--quick", "--json", str(tmp_path / "d.json")]) == 0
    _, rows = read(tmp_path / "d.json")
    assert [r["scene"] for r in rows] == list(dissipative.QUICK)
    assert all(r["outcome"] == "fine" and 0.0 < r["error"] < r["limit"] for r in rows)
    refused = dissipative.measure("car_at_rest_100s", "runge_kutta_8", 0.01)
    assert (refused["outcome"], refused["error"]) == ("refused", None)
    assert "element states" in refused["reason"]
    written = dissipative.dissipative_blocks([*rows, refused])["dissipative"]
    assert written.count("fine") == 2
    assert "0.01: refused" in written
    assert "spinning_beam" in capsys.readouterr().out


@pytest.mark.slow
def test_the_default_warns_where_it_is_wrong_and_nowhere_else(tmp_path, capsys):
    assert honesty.main(["scenes", "--quick", "--json", str(tmp_path / "h.json")]) == 0
    _, rows = read(tmp_path / "h.json")
    verdicts = {(r["scene"], r["h_s"]): r["verdict"] for r in rows}
    assert set(verdicts.values()) == {"wrong, warned", "right"}
    assert verdicts["pendulum", 0.01] == verdicts["printed_crank_slider", 2e-5] == "right"
    assert verdicts["printed_crank_slider", 1e-3] == verdicts["tumbling_body", 0.01] == "wrong, warned"
    estimate = {(r["scene"], r["h_s"]): r["estimate"] / r["error"] for r in rows if r["estimate"] is not None}
    assert 0.8 < estimate["pendulum", 0.05] < 1.2
    assert 0.8 < estimate["printed_crank_slider", 2e-5] < 1.3
    (line,) = summary(rows)
    assert (line["silently wrong"], line["false alarms"], line["refused"]) == (0, 0, 0)
    blocks = honesty_blocks(rows)
    assert "| ALi3-P | 7 |" in blocks["honesty"]
    assert "estimate: none." in blocks["honesty exceptions"]
    assert "wrong, warned" in blocks["honesty crank"]
    assert blocks["honesty"] in capsys.readouterr().out


def test_what_goes_against_the_rule_is_counted_and_named():
    def row(error, estimate, warned):
        row = {"scene": "s", "method": "radau_5", "h_s": error, "ended": "finished", "error": error, "steps": 1.5}
        return row | {"estimate": estimate, "balance": None, "verdict": verdict_of(error, 0.05, warned)}

    rows = [row(0.2, 0.1, True), row(0.3, 0.01, False), row(0.01, None, False), row(0.02, 0.1, True)]
    rows.append(row(0.052, 0.04, False))
    verdicts = [r["verdict"] for r in rows]
    assert verdicts == ["wrong, warned", "silently wrong", "right", "false alarm", "near"]
    (line,) = summary(rows)
    assert (line["right"], line["wrong, warned"], line["silently wrong"], line["false alarms"]) == (2, 1, 1, 1)
    assert (line["near the limit"], line["steps over its own"]) == (1, 1.5)
    assert (line["estimates"], line["within ten times"]) == (4, 0.75)
    exceptions = honesty_blocks(rows)["honesty exceptions"]
    assert "silently wrong: s at 0.3 s (0.3)" in exceptions
    assert "false alarm: s at 0.02 s (0.02)" in exceptions
    assert "estimate 1.0e-02" in exceptions


@pytest.mark.slow
def test_growth_fits_exponents_and_draws(tmp_path):
    files = ["--json", str(tmp_path / "g.json"), "--chart", str(tmp_path / "growth.png")]
    assert cost.main(["growth", "--quick", *files]) == 0
    _, rows = read(tmp_path / "g.json")
    known = [{"N": n, **dict.fromkeys(cost_growth.EXPONENTS, 3.0 * n**1.5)} for n in (10, 20, 50)]
    assert cost_growth.exponents(known) == pytest.approx(dict.fromkeys(cost_growth.EXPONENTS, 1.5))
    assert {"growth", "exponents"} == set(cost_growth.growth_blocks(rows))
    assert (tmp_path / "growth.png").read_bytes().startswith(PNG)


def test_time_at_equal_error_lies_on_the_curve_and_no_curve_is_extended():
    def row(wall, error):
        return {"method": "m", "h_s": 1.0 / wall, "wall_s": wall, "position_error_m": error}

    rows = [row(1.0, 1e-2), row(10.0, 1e-4), row(100.0, 1e-6)]
    assert time_at_error(rows, "m", 1e-3) == pytest.approx(np.sqrt(10.0))
    assert time_at_error(rows, "m", 1.0) == 1.0
    assert time_at_error(rows, "m", 1e-7) is None
    assert time_at_error(rows, "other", 1e-3) is None


def test_a_lucky_step_does_not_count():
    errors = {1.0: 1e-2, 10.0: 1e-5, 100.0: 1e-3, 1000.0: 1e-5, 10000.0: None}
    rows = [{"method": "m", "h_s": 1.0 / w, "wall_s": w, "position_error_m": e} for w, e in errors.items()]
    assert time_at_error(rows, "m", 1e-4) == pytest.approx(np.sqrt(100.0 * 1000.0))
    assert time_at_error(rows, "m", 2e-3) < 10.0
    assert time_at_error(rows[:3], "m", 1e-4) is None


def test_margins_count_decades_around_the_default_and_stop_at_the_first_gap():
    def row(h, value, outcome):
        return {"scene": "s", "method": "m", "h_s": h, "parameter": "eps", "value": value, "outcome": outcome}

    rows = [row(h, None, "fine" if h < 0.1 else "wrong") for h in (1e-3, 1e-2, 0.1)]
    centre = Settings().eps_rel
    rows += [
        row(h, centre * 10.0**k, "fine" if -2 <= k <= 1 else "refused") for h in (1e-3, 1e-2) for k in range(-3, 3)
    ]
    (line,) = margins(rows)
    assert (line["smallest_fine_h_s"], line["largest_fine_h_s"]) == (1e-3, 1e-2)
    assert line["first_break"] == "wrong at 0.1 s"
    assert line["decades_below"] == pytest.approx(3.0)
    assert line["decades_above"] == pytest.approx(2.0)


def test_the_puma_table_has_the_paper_beside_it(tmp_path):
    assert paper.main(["puma", "--quick", "--json", str(tmp_path / "p.json")]) == 0
    _, rows = read(tmp_path / "p.json")
    actual = {r["h_s"]: r for r in rows}
    assert actual[0.01]["paper_error_mm"] == pytest.approx(0.53)
    assert actual[0.005]["error_mm"] < 0.3 * actual[0.01]["error_mm"] < 0.3  # mm
    assert actual[0.1]["ended"] == "finished" or "refused" in actual[0.1]["ended"]
