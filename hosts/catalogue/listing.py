"""Prints a list of the standard tests (``ali3 catalogue --list``)."""

import math

from ali3.units import typeset
from hosts.catalogue.record import Setting, Standard, StandardTest
from hosts.catalogue.registry import TESTS, standard_test


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
