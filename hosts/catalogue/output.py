"""The tests and their measures on the terminal, and the measures as files."""

import csv
import io
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ali3.columns import in_columns
from ali3.files import write_json, write_text
from ali3.units import typeset
from hosts.catalogue.car import TestedCar
from hosts.catalogue.registry import TESTS, standard_test
from hosts.catalogue.standard_test import Setting, Standard, StandardTest, TestRecord
from hosts.catalogue.task import Outcome, run_file
from hosts.common.numbers import or_null
from hosts.measures.measure import Measure

_COLUMNS = ("test", "car", "measure", "value", "unit", "lowest", "highest", "kept", "limit", "note", "text")


def measures_csv(tests: Sequence[StandardTest], outcomes: Mapping[str, Mapping[str, Outcome]]) -> str:
    """CSV with a row for each measure, and a row with the reason for each test that was not done.

    `outcomes`: outcomes by name of the test and label of the car.
    """
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(_COLUMNS)
    for test in tests:
        for label, outcome in outcomes.get(test.name, {}).items():
            if isinstance(outcome, str):
                writer.writerow([test.name, label, "", "", "", "", "", "", "", outcome, ""])
                continue
            for m in outcome.measures:
                low, high, source = (m.limit.lowest, m.limit.highest, m.limit.source) if m.limit else ("", "", "")
                is_kept = "" if m.is_kept is None else str(m.is_kept).lower()
                value = repr(float(m.value))
                writer.writerow([test.name, label, m.name, value, m.unit, low, high, is_kept, source, m.note, m.text])
    return stream.getvalue()


def measures_record(
    tests: Sequence[StandardTest],
    cars: Sequence[TestedCar],
    outcomes: Mapping[str, Mapping[str, Outcome]],
    settings: Mapping[str, Mapping[str, float]],
) -> dict[str, Any]:
    """Cars, settings, measures and notes of all tests for JSON; missing numbers are null."""
    return {
        "cars": [
            {"label": car.label, "fmu": str(car.path), "step_s": car.facts.step, "set": dict(car.start)} for car in cars
        ],
        "tests": [
            {
                "name": test.name,
                "title": test.title,
                "standards": [s.name for s in test.standards],
                "settings": dict(settings[test.name]),
                "cars": {
                    label: _outcome_record(test.name, label, o) for label, o in outcomes.get(test.name, {}).items()
                },
            }
            for test in tests
        ],
    }


def _outcome_record(test: str, label: str, outcome: Outcome) -> dict[str, Any]:
    if isinstance(outcome, str):
        return {"done": False, "reason": outcome}
    return {
        "done": True,
        "measures": {m.name: _measure_record(m) for m in outcome.measures},
        "runs": {name: run_file(test, label, name).as_posix() for name in outcome.runs},
        "notes": list(outcome.notes),
    }


def _measure_record(m: Measure) -> dict[str, Any]:
    record = {name: value for name, value in m.record().items() if name != "note" or value}
    if m.limit is not None:
        limit = {"lowest": or_null(m.limit.lowest), "highest": or_null(m.limit.highest), "source": m.limit.source}
        record |= {"limit": limit, "kept": m.is_kept}
    return record


def write_measures(
    out: Path,
    tests: Sequence[StandardTest],
    cars: Sequence[TestedCar],
    outcomes: Mapping[str, Mapping[str, Outcome]],
    settings: Mapping[str, Mapping[str, float]],
) -> list[Path]:
    """Write ``measures.csv`` and ``measures.json`` into a folder. Returns their paths."""
    table, record = out / "measures.csv", out / "measures.json"
    write_text(table, measures_csv(tests, outcomes))
    write_json(record, measures_record(tests, cars, outcomes, settings))
    return [table, record]


def print_measures(
    tests: Sequence[StandardTest], cars: Sequence[TestedCar], outcomes: Mapping[str, Mapping[str, Outcome]]
) -> None:
    """Print a table for each test: measures in rows, cars in columns."""
    labels = [car.label for car in cars]
    for test in tests:
        by_label = outcomes.get(test.name, {})
        print(f"\n{test.title} ({test.name}; {', '.join(s.name for s in test.standards) or 'no standard'})")
        records = {label: o for label, o in by_label.items() if isinstance(o, TestRecord)}
        rows = [["measure", "unit", *labels]] if records else []
        for name in dict.fromkeys(m.name for o in records.values() for m in o.measures):
            by_car = {label: m.displayed() for label, o in records.items() for m in o.measures if m.name == name}
            unit = next(iter(by_car.values())).unit
            rows.append([name, typeset(unit), *(_cell(by_car.get(label)) for label in labels)])
        _print_rows(rows)
        for label, outcome in by_label.items():
            for sentence in (outcome,) if isinstance(outcome, str) else _sentences(outcome):
                print(f"  {label}: {sentence}" if len(labels) > 1 else f"  {sentence}")


def _sentences(record: TestRecord) -> list[str]:
    """The notes of a test, and the reasons of missing measures with their names."""
    missing: dict[str, list[str]] = {}
    for m in record.measures:
        if m.note and not math.isfinite(m.value):
            missing.setdefault(m.note, []).append(m.name)
    return [*dict.fromkeys(record.notes), *(f"{', '.join(names)}: {note}" for note, names in missing.items())]


def _cell(measure: Measure | None) -> str:
    if measure is None:
        return "-"
    return f"{measure.value:.4g}{'' if measure.is_kept is not False else ' (!)'}"


def _print_rows(rows: Sequence[Sequence[str]]) -> None:
    for line in in_columns(rows, range(2, len(rows[0]) if rows else 0)):
        print(f"  {line}")


def print_tests() -> None:
    """Print all tests with their standards, needs and settings."""
    for name in TESTS:
        print("\n".join(_test_lines(standard_test(name))))


def _test_lines(test: StandardTest) -> list[str]:
    lines = [f"{test.name}: {test.title}"]
    lines += [f"  after {_standard_text(standard)}" for standard in test.standards]
    lines.append(f"  needs {', '.join(need.replace(' | ', ' or ') for need in test.needs) or 'nothing'}")
    lines += [f"  --test-setting {test.name}.{_setting_text(setting)}" for setting in test.settings]
    return lines


def _standard_text(standard: Standard) -> str:
    checked = sum(clause.checked for clause in standard.clauses)
    if not standard.clauses or not checked:
        source = "from public summaries"
    elif checked == len(standard.clauses):
        source = "checked against its text"
    else:
        source = f"{checked} of {len(standard.clauses)} clauses checked against its text, the others from summaries"
    return f"{standard.name}, {standard.title} ({source})"


def _setting_text(setting: Setting) -> str:
    unit = f" {typeset(setting.unit)}".rstrip()
    limits = [f"from {setting.lowest:g}"] if math.isfinite(setting.lowest) else []
    limits += [f"to {setting.highest:g}"] if math.isfinite(setting.highest) else []
    range_text = f" ({' '.join(limits)})" if limits else ""
    return f"{setting.name}={setting.value:g}{unit}{range_text}: {setting.text}"
