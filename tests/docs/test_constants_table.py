"""The numbers of the check of a run: those of the code are those of the page, all of them."""

import ast
import re
from importlib import import_module

from mbs.results.accuracy import MAX_COST
from mbs.simulation.run import simulate
from tests.docs.test_documents import ROOT

MODULES = {
    "results": ("accuracy", "comparison", "convergence", "smooth_laws", "step_control"),
    "simulation": ("coarser_run", "fixed_steps", "refined_run", "controlled_pair", "tolerance_run"),
}
SOURCES = ("mbs/kernel/src/sensors/comparison.c", "fmu_src/native/src/half_steps.c")
ELSE = {
    "SYSTEM_VERSION",
    "STATE_VERSION",
    "POSE",
    "LONGEST_SETTLING",
    "SETTLING_WORK",
    "OPEN",
    "FARTHEST",
    "FASTEST",
    "REST_SPEED",
}
"""Numbers of the header that are not of the check (the speed of rest is of the energy balance); any other is."""
NOT_TUNED = {"comparison.c KINDS", "comparison.c PI", "step_control FINER", "half_steps.c MOST_PENDING"}
"""Counts, pi, what follows from another number, and the size of a buffer, which changes no verdict."""
WORTH = {"%": 0.01, "s": 1.0, "rad": 1.0, "": 1.0}


def in_python() -> dict[str, float]:
    """Names in capitals that a module gives a value with a number in it."""
    results = {}
    for room, names in MODULES.items():
        for name in names:
            module = import_module(f"mbs.{room}.{name}")
            body = ast.parse((ROOT / "mbs" / room / f"{name}.py").read_text(encoding="utf-8")).body
            for line in (line for line in body if isinstance(line, ast.Assign)):
                constants = [n.value for n in ast.walk(line.value) if isinstance(n, ast.Constant)]
                targets = [n.id for t in line.targets for n in ast.walk(t) if isinstance(n, ast.Name)]
                if not any(isinstance(n, int | float) for n in constants):
                    continue
                values = {t: getattr(module, t) for t in targets}
                results |= {f"{name} {t}": v for t, v in values.items() if isinstance(v, int | float)}
    return results


def in_c() -> dict[str, float]:
    """Static constants and enumerators of a value, and numbers of the header."""
    results = {}
    for source in SOURCES:
        text = (ROOT / source).read_text(encoding="utf-8")
        for line in re.findall(r"static const \w+ (.*?);|enum \{ (.*?) \}", text, re.DOTALL):
            for name, value in re.findall(r"([A-Z_]+) = ([\d.e-]+)", "".join(line)):
                results[f"{source.rsplit('/', 1)[1]} {name}"] = float(value)
    header = (ROOT / "mbs/kernel/include/ali3.h").read_text(encoding="utf-8")
    for name, value in re.findall(r"#define ALI3_(\w+) ([\d.e-]+)\b", header):
        if name not in ELSE:
            results[f"ali3.h {name}"] = float(value)
    return results


def on_the_page() -> dict[str, float]:
    page = (ROOT / "docs" / "accuracy.md").read_text(encoding="utf-8").split("## Numbers of the check")[1]
    rows = re.findall(r"^\| ([\d.e-]+) ?(%|s|rad)? \| `([\w. ]+)` \|", page, re.MULTILINE)
    return {name: float(number) * WORTH[unit] for number, unit, name in rows}


def test_the_numbers_of_the_check_are_those_of_the_page() -> None:
    code = {name: value for name, value in (in_python() | in_c()).items() if name not in NOT_TUNED}
    page = on_the_page()
    assert sorted(code) == sorted(page)
    assert len(code) <= 1 + 12  # what is wrong is a definition
    assert {name: round(value, 12) for name, value in page.items()} == {n: round(v, 12) for n, v in code.items()}


def test_the_docstring_of_simulate_has_the_limit_of_cost() -> None:
    assert f"at most {MAX_COST:g} times the run" in " ".join((simulate.__doc__ or "").split())
