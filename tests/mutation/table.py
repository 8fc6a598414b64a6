"""The tables of mutants: a file of the engine, a text in it, what stands there instead, and the tests that must notice.

    @ brake.c: elements/test_brake.py
    - fabs(trial) <= bound
    + fabs(trial) >= bound

A line with `@` names the file by the end of its path, and test files below `tests/`; it holds for all pairs of `-` and
`+` up to the next one. A text is a part of one line, without the spaces around it, and occurs once in the files of that
name. An empty `+` takes it away. What is changed must compile without a warning. Lines with `#` are comments.
"""

import functools
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SOURCES = ("ali3", "mbs", "fmu_src", "hosts", "viewer", "benchmarks")
SUFFIXES = (".c", ".h", ".js", ".py")


@dataclass(frozen=True)
class Mutant:
    """One row of a table."""

    file: str
    """End of the path of the file."""
    original: str
    changed: str
    """`original`, `changed`: the text and what replaces it."""
    tests: tuple[str, ...]
    """Test files, from the root of the project."""

    def __str__(self) -> str:
        return f"{self.file}: {self.original} -> {self.changed or '(nothing)'}"

    def apply(self, root: Path = ROOT) -> tuple[Path, str]:
        """The file below `root` that the row means, and its changed content.

        Raises `ValueError` where the text is not there exactly once.
        """
        results = [(path, path.read_text(encoding="utf-8")) for path in files_named(self.file, root)]
        count = sum(content.count(self.original) for _, content in results)
        if count != 1:
            raise ValueError(f"{self.file} has the text {self.original!r} {count} times; it must be there once")
        path, content = next((path, content) for path, content in results if self.original in content)
        return path, content.replace(self.original, self.changed)


def files_named(name: str, root: Path = ROOT) -> list[Path]:
    """Sources whose path ends with the name."""
    parts = Path(name).parts
    return [path for path in _sources(root).get(parts[-1], ()) if path.parts[-len(parts) :] == parts]


@functools.cache
def _sources(root: Path) -> dict[str, list[Path]]:
    """All sources by the last part of their path: mutants change what is in them, not which there are."""
    results: dict[str, list[Path]] = {}
    for folder in SOURCES:
        for path in sorted((root / folder).rglob("*.*")):
            if path.suffix in SUFFIXES:
                results.setdefault(path.name, []).append(path)
    return results


def read_table(path: Path) -> list[Mutant]:
    """The rows of a table. Raises `ValueError` with the line that cannot be read."""
    file, tests, original, rows = "", (), None, []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        mark, text = line[:1], line[1:].strip()
        if mark == "@" and ":" in text and original is None:
            file, _, names = text.partition(":")
            tests = tuple(f"tests/{name}" for name in names.split())
        elif mark == "-" and text and tests and original is None:
            original = text
        elif mark == "+" and original is not None and original != text:
            rows.append(Mutant(file, original, text, tests))
            original = None
        elif line.strip() and mark != "#":
            raise ValueError(f"{path.name}, line {number}: {line!r} does not belong here")
    if original is not None:
        raise ValueError(f"{path.name} ends without what replaces {original!r}")
    return rows


def all_mutants() -> list[Mutant]:
    """The rows of all tables."""
    return [row for path in sorted(HERE.glob("*.txt")) for row in read_table(path)]
