"""Docstrings of public functions and methods say what names and types do not: units of numbers, shapes of arrays. The
reference pages are made of this.
"""

import ast
import importlib
import inspect
import pkgutil
import re
import textwrap
from collections.abc import Iterator
from dataclasses import is_dataclass
from typing import Any

import pytest

import mbs.scenes
from mbs.elements.reals import Real, declared, texts_of
from tests.house.test_import_directions import ROOT

ROOMS = ("mbs", "mbs.model", "mbs.elements", "mbs.flexible")
SECTION = re.compile(r"^(Parameters|Returns|Yields|Raises|Warns|Attributes|Notes|Examples)\n-+$", re.MULTILINE)
UNIT = re.compile(
    r"\b(m|mm|m2|kg|m3|m/s2?|s|N|rad|deg|degrees|Hz|J|W|Pa|K|[Ff]actor|[Rr]atio|[Ss]hare"
    r"|[Ee]fficiency|[Cc]oefficient|Multiplies|[Rr]elative|units?"
    r"|[Tt]urns|[Mm]ultiple|[Ff]raction|0 to 1)\b|%|(?:See|As in) `"
)
"""A unit, a word that says that there is none, or where it stands."""
LITTLE = (
    *("a", "an", "the", "of", "this", "that", "it", "its", "is", "are", "as", "for", "in", "with", "and", "or", "to"),
    *("from", "one", "given", "stands", "model", "system", "name", "number", "value", "object", "array", "like"),
    *("float", "int", "str", "bool", "sequence", "optional", "none"),
)
"""Words that say nothing of what something is."""


def _names() -> Iterator[tuple[str, Any]]:
    """What the rooms export, and how each scene is built."""
    for room in ROOMS:
        module = importlib.import_module(room)
        for name in module.__all__:
            yield f"{room}.{name}", getattr(module, name)
    for scene in pkgutil.iter_modules(mbs.scenes.__path__):
        module = importlib.import_module(f"mbs.scenes.{scene.name}")
        yield f"mbs.scenes.{scene.name}.build", module.build


def _functions() -> dict[str, Any]:
    """Public functions and methods, each once."""
    results: dict[Any, str] = {}
    for name, thing in _names():
        if inspect.isfunction(thing):
            results.setdefault(thing, name)
        elif inspect.isclass(thing) and thing.__module__.startswith("mbs"):
            for method, member in inspect.getmembers(thing):
                function = getattr(member, "__func__", member)
                public = inspect.isfunction(function) and not method.startswith("_")
                if public and function.__module__.startswith("mbs"):
                    results.setdefault(function, f"{name}.{method}")
    return {name: function for function, name in results.items()}


FUNCTIONS = _functions()


def _entries(text: str, section: str = "Parameters") -> dict[str, str]:
    """What a section says under each of its names; the type after the colon goes before it."""
    head = f"{section}\n{'-' * len(section)}\n"
    if head not in text:
        return {}
    results: dict[str, str] = {}
    names: list[str] = []
    for line in SECTION.split(text.split(head, 1)[1])[0].splitlines():
        if line and not line.startswith(" "):
            listed, _, kind = line.partition(" :")
            names = [name.strip().lstrip("*") for name in listed.split(",")]
            results |= dict.fromkeys(names, kind)
        else:
            results |= {name: f"{results[name]}\n{line.strip()}" for name in names}
    return results


def _faults(text: str, parameters: dict[str, str]) -> list[str]:
    """What is wrong with a docstring; `parameters` are names and annotations."""
    entries, wrong = _entries(text), []
    wrong += [f"{name} is not a parameter" for name in entries if name not in parameters]
    for name, entry in entries.items():
        own = set(LITTLE).union(re.findall(r"[a-z]+", f"{name} {parameters.get(name, '')}".lower()))
        if not set(re.findall(r"[^\W_]+", entry.partition("\n")[2].lower())) - own:
            wrong.append(f"the entry of {name} says nothing")
    for name, kind in parameters.items():
        if re.search(r"\bfloat\b", kind) and not UNIT.search(entries.get(name, "")):
            wrong.append(f"{name} is a number without a unit")
        if re.search(r"\b(ArrayLike|NDArray|Vector)\b", kind) and "shape" not in entries.get(name, ""):
            wrong.append(f"{name} is an array without a shape")
    return wrong


def _written_annotations(function: Any) -> dict[str, str]:
    """Annotations as they stand in the source: an alias such as `End` has its shape where it is defined."""
    (defined,) = ast.parse(textwrap.dedent(inspect.getsource(function))).body
    assert isinstance(defined, ast.FunctionDef)
    arguments = [node for node in ast.walk(defined.args) if isinstance(node, ast.arg)]
    return {a.arg: ast.unparse(a.annotation) for a in arguments if a.annotation is not None}


def test_docstrings_say_units_and_shapes_and_nothing_empty():
    assert len(FUNCTIONS) > 150
    wrong = []
    for name, function in FUNCTIONS.items():
        kinds = _written_annotations(function)
        wrong += [f"{name}: {fault}" for fault in _faults(inspect.getdoc(function) or "", kinds)]
    assert not wrong, "\n".join(wrong)


def _bare_entries(text: str) -> list[str]:
    """Names of a docstring's parameters that have no text below, and whose types tell no shape."""
    return [
        name
        for section in ("Parameters", "Attributes")
        for name, entry in _entries(text, section).items()
        if not entry.partition("\n")[2].strip() and not re.search(r"shape|length|\{|array of", entry)
    ]


@pytest.mark.slow
def test_no_entry_only_repeats_a_name_and_a_type():
    """Of all functions and classes of the product, private ones too."""
    wrong, count = [], 0
    for room in ("ali3", "benchmarks", "fmu_src", "hosts", "mbs", "viewer"):
        for file in sorted((ROOT / room).rglob("*.py")):
            for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
                text = ast.get_docstring(node) if isinstance(node, ast.FunctionDef | ast.ClassDef) else None
                if text is not None:
                    count += 1
                    wrong += [f"{file.relative_to(ROOT)}: {node.name}: {name}" for name in _bare_entries(text)]
    assert not wrong, "\n".join(wrong)
    assert count > 3000


def _attributes(kind: type) -> dict[str, str]:
    """The text under each attribute of a class, and of those that it inherits."""
    inherited = _attributes(kind.__base__) if is_dataclass(kind.__base__) else {}
    return inherited | texts_of(kind)


def test_numbers_of_elements_say_their_units():
    wrong, count = [], 0
    for kind in (thing for _, thing in _names() if inspect.isclass(thing) and thing.__module__.startswith("mbs.elem")):
        texts = _attributes(kind)
        numbers = [name for name, real in declared(kind).items() if isinstance(real, Real) and not real.name]
        count += len(numbers)
        wrong += [f"{kind.__name__}.{name}" for name in numbers if not UNIT.search(texts.get(name, ""))]
    assert not wrong, "\n".join(wrong)
    assert count > 80
