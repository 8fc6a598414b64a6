"""Fidelities of the car: choosing one from measured rows, one measured row, the chart; the naive models."""

import json
from pathlib import Path

import numpy as np
import pytest

from benchmarks.car import fidelity, fidelity_runs
from benchmarks.methods import unreduced_models
from mbs.vehicle import Fidelity


def row(model: str, h: float, us: float, moment: float | None, motion: float, name: str = "kerb") -> dict[str, object]:
    return {"manoeuvre": name, "fidelity": model, "h_s": h, "us_per_step": us, "moment": moment, "motion": motion}


ROWS = [
    row("rigid", 0.01, 40.0, None, 0.005),
    row("quasi_static", 0.01, 60.0, 0.08, 0.005),
    row("quasi_static", 0.002, 60.0, 0.06, 0.004),
    row("dynamic", 0.01, 250.0, 0.03, 0.001),
    row("many_modes", 0.01, 400.0, 0.02, 0.001),
]


def test_the_cheapest_that_is_good_enough() -> None:
    assert fidelity.cheapest(ROWS, "motion", 0.01).fidelity is Fidelity.RIGID
    stress = fidelity.cheapest(ROWS, "moment", 0.1)
    assert (stress.fidelity, stress.h, stress.error) == (Fidelity.QUASI_STATIC, 0.01, 0.08)
    assert stress.ms_per_second == pytest.approx(6.0)
    fine = fidelity.cheapest(ROWS, "moment", 0.05)
    assert fine.fidelity is Fidelity.DYNAMIC
    assert "above the fifth" in fine.left_out


def test_it_must_be_good_in_every_manoeuvre() -> None:
    other = [row("quasi_static", 0.01, 60.0, 0.3, 0.01, "drop"), row("dynamic", 0.01, 250.0, 0.04, 0.01, "drop")]
    assert fidelity.cheapest([*ROWS, *other], "moment", 0.1).fidelity is Fidelity.DYNAMIC


@pytest.mark.parametrize(
    ("output", "tolerance", "message"),
    [
        ("noise", 0.1, "no output 'noise'"),
        ("moment", 0.0, "must be positive"),
        ("moment", 0.001, "the best is 0.02 away"),
    ],
)
def test_invalid_choices_are_refused(output: str, tolerance: float, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        fidelity.cheapest(ROWS, output, tolerance)


@pytest.mark.slow
def test_measured_rows_and_chart(tmp_path: Path) -> None:
    rows = [fidelity.measure("kerb_test", f, 0.01, 1) for f in (Fidelity.RIGID, Fidelity.QUASI_STATIC)]
    assert rows[0]["moment"] is None
    assert 0.0 < rows[1]["moment"] < 0.05
    assert rows[1]["coordinates"] > rows[0]["coordinates"]
    json.dumps(rows)
    fidelity.chart(rows, tmp_path / "fidelity.png")
    assert (tmp_path / "fidelity.png").stat().st_size > 10_000


def test_errors_of_a_reference_with_itself_are_nothing() -> None:
    reference = fidelity_runs.read_reference("drop")
    assert set(fidelity_runs.errors(reference, reference).values()) == {0.0}
    other = reference | {"chassis.x": reference["chassis.x"] + 0.5}
    assert fidelity_runs.errors(other, reference)["motion"] == pytest.approx(0.5)


def test_naive_models_move_alike_and_are_larger() -> None:
    for scene in ("double four-bar", "prototype car"):
        result = unreduced_models.measure(scene, 1)
        assert result["naive_coordinates"] > 2 * result["coordinates"]
        assert result["naive_rows"] > 2 * result["rows"]
        assert result["difference"] < 0.01
    assert np.isfinite(result["factor"])
