"""Starts of a fit that the FMU refuses are left out and reported; one that the user has set is an error."""

import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from hosts.common.errors import HostError
from hosts.compare.command import main
from hosts.compare.cross_validation import parts_of
from hosts.compare.fit import fit
from hosts.compare.fit_text import fit_notes
from hosts.compare.fit_unknowns import Unknown
from hosts.driving.co_simulation import run
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.result import Result
from hosts.fmu.fmu import Fmu
from hosts.measures.signal import Signal

pytestmark = pytest.mark.usefixtures("in_process")

RATE = 2.0
REFUSED = 3.0
T = np.linspace(0.0, 3.0, 151)


def decaying(values: Mapping[str, float]) -> Result | str:
    """exp(-rate t), which is refused from a rate on."""
    if values["rate"] > REFUSED:
        return "It is too fast."
    y = np.exp(-values["rate"] * T)[:, None]
    return Result(["y"], {"y": "m"}, T, y, 0.0, float(T[-1]), 0, [])


def fitted(start: float, starts: int):  # type: ignore[no-untyped-def]
    measured = np.exp(-RATE * T) + 0.01 * np.random.default_rng(1).normal(size=len(T))
    signal = Signal("y", "y", "m", T, measured)
    return fit({"y": signal}, [Unknown("rate", "1/s", start, 0.5, 5.0, 1.0)], decaying, starts=starts)


def test_refused_starts_are_left_out_and_reported() -> None:
    actual = fitted(1.0, 4)
    assert len(actual.starts) + len(actual.refused) == 4
    assert len(actual.refused) >= 1
    assert all(start.begin[0] <= REFUSED for start in actual.starts)
    assert abs(actual.found[0].value - RATE) < 2.0 * actual.found[0].half_width
    notes = [note for note in fit_notes(actual) if note.startswith("Another start (--starts) is left out.")]
    assert len(notes) == len(actual.refused)
    assert float(notes[0].rpartition("rate = ")[2].split()[0]) > REFUSED
    assert actual.found[0].value == pytest.approx(fitted(1.0, 1).found[0].value, abs=1e-4)


def test_a_log_that_the_start_meets_to_the_last_bit_is_fitted() -> None:
    signal = {"y": Signal("y", "y", "m", T, np.exp(-RATE * T))}
    parts = parts_of(signal, [])
    found = fit(signal, [Unknown("rate", "1/s", RATE, 0.5, 2.9, 1.0)], decaying, parts=parts)
    assert (found.found[0].value, found.after, found.left_out) == (RATE, 0.0, {"y": 0.0})
    assert not [note for note in fit_notes(found) if "has no effect: parts of the log" in note]


def test_given_values_that_are_refused_end_the_fit() -> None:
    with pytest.raises(HostError, match=r"refuses rate = 4 1/s\. It is too fast\."):
        fitted(4.0, 3)


@pytest.mark.slow
def test_values_with_which_no_run_starts_are_left_out(prototype_fmu: Path, tmp_path: Path) -> None:
    """A moment of inertia above the other two together is of no body: the FMU is not initialised with it."""
    t = np.array([0.0, 0.1, 0.2, 1.0])
    steered = {"steering": np.array([0.0, 0.0, 0.3, 0.3])}
    with Fmu(prototype_fmu) as fmu:
        result = run(fmu, Manoeuvre("step", t, steered, 1.0, {"initial.speed": 15.0}), 0.01)
    log, record = tmp_path / "step.csv", tmp_path / "record.json"
    columns = np.column_stack([result.time, *(result[n] for n in ("steering", "speed", "chassis.wz"))])
    np.savetxt(log, columns, delimiter=",", header="time,steering,speed,chassis.wz", comments="", fmt="%.9g")
    chosen = ["--signals", "chassis.wz", "--set", "chassis.inertia.z=400", "--set", "initial.settling=0"]
    chosen += ["--fit", "chassis.inertia.z=300:900"]
    written = ["--out", str(tmp_path / "out"), "--json", str(record)]
    assert main([str(prototype_fmu), str(log), *chosen, "--starts", "3", *written]) == 0
    fitted = json.loads(record.read_text())["fit"]
    assert len(fitted["starts"]) + len(fitted["refused_starts"]) == 3
    assert fitted["refused_starts"]
    assert all("moments of inertia" in message for message in fitted["refused_starts"])
    assert [start["end"][0] for start in fitted["starts"]] == pytest.approx([457.7] * len(fitted["starts"]), rel=0.002)
