"""Limits of the user are judged beside those of standards, in any unit of the quantity."""

import json
import math
from pathlib import Path

import pytest

from ali3.units import known_unit
from hosts.catalogue import command
from hosts.catalogue.car import TestedCar
from hosts.catalogue.execution import settings_of_test
from hosts.catalogue.limits import GivenLimits
from hosts.catalogue.registry import TESTS, read_test_file, standard_test
from hosts.catalogue.standard_test import TestRecord
from hosts.catalogue.task import Outcome, Task, store_record
from hosts.common.errors import HostError
from hosts.experiment.store import ResultStore
from hosts.fmu.fmu_source import FmuSource
from hosts.measures.limits import read_limits
from hosts.measures.measure import Limit, Measure


def record(peak: float, critical: bool = True) -> TestRecord:
    speed = Measure("critical_speed", 20.0 if critical else math.nan, "m/s", "", exists=critical)
    rest = Measure("rest", 0.5, "1", "", Limit("at rest", -1.0, 1.0))
    return TestRecord([Measure("peak", peak, "N", ""), speed, rest], [], {})


def limits(folder: Path, text: str) -> GivenLimits:
    file = folder / "limits.toml"
    file.write_text(f"[limits]\n{text}\n[measures]\nanother = 'table of a study'\n")
    return GivenLimits(file, read_limits(file))


def kept(outcomes: dict[str, dict[str, Outcome]]) -> dict[tuple[str, str], bool | None]:
    return {
        (label, m.name): m.is_kept
        for by_car in outcomes.values()
        for label, o in by_car.items()
        if isinstance(o, TestRecord)
        for m in o.measures
    }


def test_each_car_is_held_against_the_limits(tmp_path):
    own_limits = limits(tmp_path, 'peak = {max = 2.0, unit = "kN"}\n"drop.critical_speed" = {min = 80, unit = "km/h"}')
    result, faults = own_limits.apply_to(
        {"drop": {"a": record(1999.0), "b": record(2001.0, False), "c": "It has no wheels."}}
    )
    assert not faults
    assert kept(result) == {
        **{("a", "peak"): True, ("a", "critical_speed"): False, ("a", "rest"): True},
        **{("b", "peak"): False, ("b", "critical_speed"): None, ("b", "rest"): True},
    }
    assert result["drop"]["c"] == "It has no wheels."


@pytest.mark.parametrize(("least", "both"), [(0.4, True), (0.6, False)])
def test_the_limit_of_a_standard_holds_too(tmp_path, least, both):
    outcomes, _ = limits(tmp_path, f"rest = {{min = {least}, max = 9.0}}").apply_to({"drop": {"a": record(1.0)}})
    outcome = outcomes["drop"]["a"]
    assert isinstance(outcome, TestRecord)
    assert outcome.measures[2].limit == Limit("at rest; limits.toml", least, 1.0)
    assert outcome.measures[2].is_kept is both


def test_a_limit_of_nothing_is_reported_and_the_others_are_judged(tmp_path):
    own_limits = limits(
        tmp_path, 'peek = {max = 1}\n"rest.unit" = {max = 1}\npeak = {max = 1}\n"drop.peak" = {min = 0}'
    )
    result, faults = own_limits.apply_to({"drop": {"a": record(2.0)}})
    assert kept(result)["a", "peak"] is False
    assert [fault.removeprefix(f"{own_limits.file}: limits.") for fault in faults] == [
        "'peek': there is no measure 'peek'; there are drop.peak, drop.critical_speed, drop.rest.",
        "'rest.unit': there is no measure 'rest.unit'; there are drop.peak, drop.critical_speed, drop.rest.",
        "'drop.peak' and another limit are both of 'drop.peak'; give one of them.",
    ]
    (fault,) = limits(tmp_path, 'peak = {max = 1, unit = "m"}').apply_to({"drop": {"a": record(2.0)}})[1]
    assert "limits.'peak'.unit" in fault


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[limit]\npeak = {max = 1}", "limits is missing"),
        ("[limits]", "limits"),
        ("[limits]\npeak = {}", "it needs min or max, or both"),
        ("[limits]\npeak = [2, 1]", "the lower one comes first"),
        ("[limits]\npeak = {most = 1}", "limits.peak.most"),
        ("limits = 3", "limits is 3"),
    ],
)
def test_a_file_without_limits_is_one_sentence(tmp_path, text, message):
    file = tmp_path / "l.toml"
    file.write_text(text)
    with pytest.raises(HostError) as refusal:
        read_limits(file)
    assert message in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_the_command_names_the_measure_outside_its_limits(prototype_fmu, tmp_path, capsys):
    task = Task(
        "drop", TestedCar(prototype_fmu.stem, FmuSource(prototype_fmu)), settings_of_test(standard_test("drop"), {})
    )
    with ResultStore[TestRecord](tmp_path, TestRecord, "does tests") as store:
        store_record(store, task, record(2001.0))
    file = limits(tmp_path, 'peak = {max = 2.0, unit = "kN"}\n"kerb.peak" = {max = 1}').file
    drop = [str(prototype_fmu), "--tests", "drop", "--no-runs", "--out", str(tmp_path)]
    assert command.main(drop) == 0
    assert command.main([*drop, "--limits", str(file)]) == 1
    output = capsys.readouterr().out
    assert "1 measure does not keep its limit; it is marked (!)." in output
    assert "limits of tests that --tests leaves out are not evaluated: kerb.peak\n" in output
    (test,) = json.loads((tmp_path / "measures.json").read_text())["tests"]
    peak = test["cars"][prototype_fmu.stem]["measures"]["peak"]
    assert peak["limit"] == {"lowest": None, "highest": 2000.0, "source": "limits.toml"}
    assert peak["kept"] is False


def test_measures_are_in_si_units():
    """Tables of data keep them; reports show degrees and km/h."""
    results = [m.unit for test in TESTS for part in read_test_file(test).parts.values() for m in part.measures.values()]
    results = [unit for unit in results if "{" not in unit]
    assert len(results) > 100
    known = {unit: known_unit(str(unit)) for unit in results}
    assert {unit: entry.factor for unit, entry in known.items() if entry is not None and entry.factor != 1.0} == {}
