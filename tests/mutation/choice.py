"""Choice of the tests that are likely to detect a mutant, the likeliest first: by names, imports and folders."""

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from tests.mutation.sample import Sampled

NEIGHBOURS = {
    "ali3": ("tests/commands",),
    "benchmarks": ("tests/benchmarks", "tests/docs"),
    "fmu_src": ("tests/fmu", "tests/hosts"),
    "hosts": ("tests/hosts",),
    "mbs": ("tests/simulation", "tests/scenes", "tests/model"),
    "mbs/compiler": ("tests/compiler", "tests/oracle"),
    "mbs/kernel": ("tests/kernel", "tests/methods", "tests/elements", "tests/simulation", "tests/scenes"),
    "mbs/vehicle": ("tests/vehicle", "tests/scenes"),
    "viewer": ("tests/viewer", "tests/hosts"),
    "viewer/page": ("viewer/page/test", "tests/viewer"),
}
"""Folders of tests beside those of the same names, by the beginning of a path; longer begins count more."""

LEFT_OUT = ("tests/house/", "tests/mutation/", "tests/commands/test_wheel.py", "tests/fmu/test_native_binaries.py")
"""They see any change of a text, or compile for other platforms."""
MOST, LIKELIEST = 24, 6


@dataclass(frozen=True)
class TestFile:
    """A file of tests."""

    __test__ = False
    name: str
    """Path from the root."""
    words: frozenset[str]
    """Names in it."""
    text: str
    """Its text."""


@cache
def test_files(root: Path) -> list[TestFile]:
    """Files of tests in Python and JavaScript."""
    results = [*(root / "tests").rglob("test_*.py"), *(root / "viewer" / "page").glob("test/*.test.js")]
    files = []
    for path in sorted(results):
        name, text = path.relative_to(root).as_posix(), path.read_text(encoding="utf-8")
        if not name.startswith(LEFT_OUT):
            files.append(TestFile(name, frozenset(re.findall(r"\w+", text)), text))
    return files


def batches_of(mutant: Sampled, root: Path) -> list[tuple[str, ...]]:
    """At most `MOST` files of tests, the quick tests of all before the slow ones of the likeliest."""
    files = _tests_of(mutant, root)
    near, far = files[:LIKELIEST], files[LIKELIEST:]
    known = [(mutant.killed_by,)] if mutant.killed_by else []
    quick = [("-m", "not slow and not proof", *part) for part in (near, far[:LIKELIEST], far[LIKELIEST:]) if part]
    return [*known, *quick, ("-m", "slow and not proof", *(name for name in near if name.endswith(".py")))]


def _tests_of(mutant: Sampled, root: Path) -> list[str]:
    path = Path(mutant.file)
    points = {file: _points(mutant, path, file) for file in test_files(root)}
    best = sorted((file for file, value in points.items() if value), key=lambda f: (-points[f], len(f.text)))
    return [file.name for file in best[:MOST]]


def _points(mutant: Sampled, path: Path, file: TestFile) -> float:
    test, stem = Path(file.name), path.stem if path.stem != "__init__" else path.parent.name
    if file.name.endswith(".js") and path.suffix != ".js":
        return 0.0
    own = test.name.partition(".")[0].removeprefix("test_")
    ours, theirs = set(own.split("_")), set(stem.split("_"))
    points = 4.0 * (own == stem) + 4.0 * len(ours & theirs) / len(ours | theirs)
    module = "/".join(path.parts[-2:]) if path.suffix == ".js" else ".".join(path.with_suffix("").parts)
    points += 5.0 * (module in file.text or (stem in file.words and path.parent.name in file.words))
    names = [name for name in mutant.function.split(".") if len(name) > 3 and not name.startswith("__")]
    points += sum(4.0 / (1 + k) for k, name in enumerate(reversed(names)) if name in file.words)
    points += 2.0 * len(set(path.parts[:-1]) & set(test.parts[:-1]))
    begins = sorted((begin for begin in NEIGHBOURS if mutant.file.startswith(f"{begin}/")), key=len)
    return points + max((1.0 + k for k, b in enumerate(begins) if file.name.startswith(NEIGHBOURS[b])), default=0.0)
