"""`ali3 check` of FMUs with one fault each, in FMI 2.0 and 3.0: each has its verdict, clause, value and remedy."""

import json
import sys
from itertools import product
from pathlib import Path

import pytest

from hosts.check.all_checks import CHECKS
from hosts.check.command import main
from tests.hosts.odd_fmus import planted_fmu
from tests.hosts.one_check import all_checks, one_check
from tests.in_process import run
from tests.quick import quick

pytestmark = [pytest.mark.slow, pytest.mark.skipif(sys.platform != "linux", reason="what Linux tells of a process")]

SETTINGS, STEPS, INSTANCES, OUTSIDE = "process settings", "costs of steps", "costs of instances", "files and prints"
PLANTS: dict[str, tuple[str, str, str]] = {
    "START_VALUE": ("start values", "BAD", "u reads 3 before it is set, and its start is 0; give it that value"),
    "FEEDTHROUGH": ("dependencies", "BAD", "as u is set, on which it is said not to depend; declare it"),
    "SEVEN": ("derivatives", "BAD", "y has the derivative 7 by u; differences are 0 at a communication point and 0.01"),
    "SIGN": ("derivatives", "BAD", "y has the derivative -0.01 by u"),
    "HALF": ("derivatives", "BAD", "y has the derivative 0.005 by u"),
    "LEAK": (STEPS, "BAD", "bytes a step; free what was allocated"),
    "THREAD": (STEPS, "BAD", "threads grow by 1 threads a step; end the threads"),
    "DESCRIPTOR": (STEPS, "BAD", "descriptors grow by 1 descriptors a step; close what"),
    "SLOW": ("time of steps", "note", "times as long; FMI sets no time for a step"),
    "BUSY": ("time of steps", "note", "between calls; stop threads"),
    "BEYOND": ("ranges", "BAD", "beyond -10 to 10; widen it"),
    "NO_END": ("end", "BAD", "answers with status 3"),
    "VERSION": ("end", "BAD", "GetVersion answers"),
    "PRINTS": (OUTSIDE, "note", "prints 'at 0 s'; give messages to the host's logger"),
    "PRINTS_ERRORS": (OUTSIDE, "note", "prints 'at 0 s'; give messages to the host's logger"),
    "FILES": (OUTSIDE, "note", "1 files were written, such as planted.txt"),
    "FOLDER": (SETTINGS, "BAD", "to / by a step; use absolute paths"),
    "LATE_FOLDER": (SETTINGS, "BAD", "to / by termination; use absolute paths"),
    "ROUNDING": (SETTINGS, "BAD", "by a step; restore rounding"),
    "ROUNDING_AT_READ": (SETTINGS, "BAD", "; restore rounding"),
    "FLUSH": (SETTINGS, "BAD", "by a step; restore rounding, flush to zero"),
    "TRAPS": (SETTINGS, "BAD", "by a step; restore rounding, flush to zero and traps"),
    "IGNORES": (SETTINGS, "BAD", "signals changed from SigIgn"),
    "BLOCKS": (SETTINGS, "BAD", "signals changed from SigBlk"),
    "HANDLES": (SETTINGS, "BAD", "signals changed from SigCgt"),
    "UMASK": (SETTINGS, "BAD", "to 0 by initialisation; pass the mode to open"),
    "LOCALE": (SETTINGS, "BAD", "locale changed from"),
    "ENVIRONMENT": (SETTINGS, "BAD", "PLANTED unset to 1 by instantiation"),
    "NOT_SET": ("set values", "BAD", "u was set to 0.001 without a message and reads 0; take it or refuse it"),
    "READ_MOVES": ("reads twice", "BAD", "with no call in between"),
    "INSTANCE_DESCRIPTOR": (INSTANCES, "BAD", "descriptors grow by 1 descriptors an instance that is freed"),
    "INSTANCE_THREAD": (INSTANCES, "BAD", "threads grow by 1 threads an instance that is freed"),
    "INSTANCE_LEAK": (INSTANCES, "note", "bytes an instance that is freed; release them there"),
    "FLOOD": ("messages", "note", "500 in 5 steps; say what repeats once"),
    "RESET_KEEPS": (
        "reset",
        "BAD",
        "not as at the first start: y is 0.005 and then 0.055 at 0.01 s; set everything back in it",
    ),
    "SHARED": ("repeats", "BAD", "a run beside a second one differs: y is "),
    "RANDOM": ("repeats", "BAD", "; keep all that a run needs in its instance"),
    "THREAD_LOCAL": ("repeats", "BAD", "a run in another thread than its instance was made in differs: y is 0.015 and"),
    "STATE_PART": ("states", "BAD", "a restored state goes on differently: y is "),
    "STATE_SPOILT": ("states", "BAD", "a state that is restored twice goes on differently: y is 0.015 and then 0.005"),
    "STATE_LEAK": ("costs of states", "BAD", "bytes a state that is freed; free what was allocated"),
    "KEEPS_POINTER": ("states", "BAD", "a state that was freed keeps its pointer; set it to NULL"),
    "OVERRUN": ("states", "BAD", "The FMU writes more than the 40 bytes that it says its state has; say the size"),
    "ONE_LENGTH": ("steps of any size", "note", "0 of 1 outputs end within 5 % of their range; step by the length"),
    "LATE_START": ("start time", "BAD", "DoStep answers with status 3 in a run that begins at 10 s; begin there"),
    "WARNS": ("quiet steps", "BAD", "a step is answered with a warning and without a message; say what it warns of"),
    "CHATTER": ("messages", "note", "logging is off, and 5 are of no problem, as 'a step'; leave them out"),
    "NO_CATEGORY": ("messages", "note", "1 have no category or text; give both"),
    "INPUT_LOST": ("set values", "BAD", "u was set to 0.37 and reads 0 after a step; it stays until it is set"),
    "NAN_AT_START": ("runs", "BAD", "y is nan at 0 s; give a number or refuse the step"),
    "READ_ORDER": ("reads twice", "BAD", "where the references are asked for the other way round; give each its value"),
    "PATHS": ("resource paths", "BAD", "in a folder named 'of a user, müller'; decode their location"),
    "TIMER": (SETTINGS, "BAD", "timers changed from ITIMER_REAL False to True by initialisation; leave timers"),
    "AFFINITY": (SETTINGS, "BAD", "scheduling changed from processors "),
    "LIMITS": (SETTINGS, "BAD", "by initialisation; leave limits of the process to the host"),
    "CLOSES": (SETTINGS, "BAD", "to closed by initialisation; leave the standard streams open"),
    "CHILD": (STEPS, "BAD", "processes grow by 1 processes a step; wait for those that it begins"),
}
"""Check, verdict and words by the fault."""
ALSO = {"FORMAT": "a message has %n: 'the mass is 100 %s %n'; double each %"}
FAULTS = list(product((*PLANTS, *ALSO), (False, True)))
FIRST = {check: plant for plant, (check, _, _) in reversed(PLANTS.items())}
FEW = [(plant, three) for plant, three in FAULTS if not three or plant in FIRST.values()]
"""Each fault in FMI 2.0, and in FMI 3.0 the first that a check finds."""


LIMITS = ("--steps", 10, "--time-limit", 10)


@pytest.mark.parametrize("three", [False, True])
def test_without_a_fault_nothing_is_bad(tmp_path: Path, three: bool) -> None:
    _, lines = all_checks(planted_fmu(tmp_path, "NONE", three), *LIMITS)
    bad = {name: message for name, (verdict, message) in lines.items() if verdict == "BAD"}
    assert not bad
    assert lines["stop time"][0] == "note"  # a step beyond it is taken
    assert lines["derivatives"][0] == "note"  # over a step, without a word


@pytest.mark.parametrize(("plant", "three"), quick(FEW, FAULTS, "proof"))
def test_each_fault_is_found(tmp_path: Path, plant: str, three: bool) -> None:
    check, verdict, message = PLANTS.get(plant) or ("messages", "note" if three else "BAD", ALSO[plant])
    actual, words = one_check(planted_fmu(tmp_path, plant, three), check)
    assert actual == verdict.lower(), words
    assert message in words
    assert f"(FMI {'3' if three else '2'}.0, " in words


def test_an_fmu_of_one_instance_in_a_process(tmp_path: Path) -> None:
    """Where it says so each check frees what was before; else it gives no second one, and that is one verdict."""
    flag = {"canHandleVariable": 'canBeInstantiatedOnlyOncePerProcess="true" canHandleVariable'}
    (tmp_path / "said").mkdir()
    _, lines = all_checks(planted_fmu(tmp_path / "said", "ONCE", False, flag), *LIMITS)
    assert not [name for name, (verdict, _) in lines.items() if verdict == "BAD"]
    assert lines["repeats"] == ("ok", "bit for bit, one after another")
    _, lines = all_checks(planted_fmu(tmp_path, "ONCE", False), *LIMITS)
    (bad,) = [message for verdict, message in lines.values() if verdict == "BAD"]
    assert bad.startswith("it is not instantiated (FMI 2.0, 2.1.5): Failed to instantiate")
    assert "checks, which call functions of the FMU" in lines["not done"][1]


def test_a_start_that_differs_by_round_off_is_a_note(tmp_path: Path) -> None:
    changes = {'<Real start="0"': '<Real start="3.0000000001"'}
    verdict, words = one_check(planted_fmu(tmp_path, "START_VALUE", False, changes), "start values")
    assert verdict == "note"
    assert "u reads 3 before it is set, and its start is 3.0000000001" in words


def test_dependencies_may_name_an_input_by_an_alias(tmp_path: Path) -> None:
    """Both have one value reference."""
    alias = '<ScalarVariable name="also" valueReference="0" causality="local"><Real/></ScalarVariable>\n'
    changes = {
        "  </ModelVariables>": f"    {alias}  </ModelVariables>",
        '<Unknown index="2" dependencies=""/>': '<Unknown index="2" dependencies="3"/>',
    }
    verdict, words = one_check(planted_fmu(tmp_path, "FEEDTHROUGH", False, changes), "dependencies")
    assert verdict == "good", words


def test_a_source_file_that_is_named_and_missing(tmp_path: Path) -> None:
    """In FMI 3.0 `buildDescription.xml` names them, see `test_check_portability`."""
    old, new = (
        '"true"/>\n  <UnitD',
        '"true"><SourceFiles><File name="gone.c"/></SourceFiles></CoSimulation>\n  <UnitD',
    )
    verdict, words = one_check(planted_fmu(tmp_path, "NONE", False, {old: new}), "source files")
    assert verdict == "bad"
    assert "1 of 1 that are named are missing: gone.c; pack them in sources (FMI 2.0, 2.3)" in words


def test_the_verdict_as_sarif(tmp_path: Path) -> None:
    """Rules, kinds and levels as version 2.1.0 has them."""
    fmu, file = planted_fmu(tmp_path, "NO_END", False), tmp_path / "out" / "verdict.sarif"
    assert run(main, fmu, "--steps", 5, "--sarif", file).returncode == 1
    log = json.loads(file.read_text(encoding="utf-8"))
    assert log["version"] == "2.1.0"
    (sarif_run,) = log["runs"]
    rules = [rule["id"] for rule in sarif_run["tool"]["driver"]["rules"]]
    assert rules == [check.name for check in CHECKS]
    by_rule = {result["ruleId"]: result for result in sarif_run["results"]}
    assert [rules[result["ruleIndex"]] for result in sarif_run["results"]] == rules
    assert (by_rule["end"]["kind"], by_rule["end"]["level"]) == ("fail", "error")
    assert "answers with status 3" in by_rule["end"]["message"]["text"]
    assert (by_rule["runs"]["kind"], by_rule["derivatives"]["kind"]) == ("pass", "open")
    assert by_rule["end"]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"] == fmu.name
