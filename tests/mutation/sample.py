"""Random mutants, stored as text: a mutant is found again if its file was moved or its lines were wrapped.

What identifies a mutant is its line, or lines where a statement has several. Spaces and line ends do not count. Where
the line stands more than once, or no longer in its file, the function around it and the lines before and after decide.
"""

import math
import random
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from itertools import takewhile
from pathlib import Path

from tests.mutation import operators
from tests.mutation.table import ROOT, SOURCES, SUFFIXES

NOT_MUTATED = {"__pycache__", "bundle", "node_modules", "test"}
MISSES = 200  # draws without a new mutant after which a room has no more
ENOUGH = 2  # points of `Sampled.find`: a line that is short may stand elsewhere by chance


@dataclass(frozen=True)
class Sampled:
    """A random mutant."""

    file: str
    """Path from the root, when it was drawn."""
    function: str
    """Classes and functions around it, with points between."""
    operator: str
    """Kind of the error."""
    before: str
    line: str
    changed: str
    """`line`, `changed`: the lines that change, and what they become."""
    after: str
    """`before`, `after`: the nearest lines that are not empty."""
    killed_by: str = ""
    """The test that failed, as pytest names it; empty if none did."""

    def __str__(self) -> str:
        line, changed = (" ".join(text.split()) for text in (self.line, self.changed))
        return f"{self.file}, {self.function or 'outside of functions'}: {line} -> {changed}"

    def find(self, root: Path = ROOT) -> tuple[Path, int]:
        """The file that has the line now, and where in its text without spaces.

        Raises `ValueError` if no place, or more than one, is alike enough.
        """
        home = root / self.file
        places = {(home, k): points for k, points in self._places(home, root).items()} if home.is_file() else {}
        if sum(points == 7 for points in places.values()) != 1:  # moved, or the line stands twice
            for path in sources(root):
                if path != home and path.suffix in operators.alike(home.suffix):
                    places |= {(path, k): points for k, points in self._places(path, root).items()}
        best = max(places.values(), default=0)
        results = [place for place, points in places.items() if points == best]
        if best < ENOUGH or len(results) != 1:
            what = (
                "the line is no longer in the code" if best < ENOUGH else f"the line fits {len(results)} places alike"
            )
            raise ValueError(f"gone, look at it by hand: {self}: {what}")
        return results[0]

    def _places(self, path: Path, root: Path) -> dict[int, int]:
        """Points of all places of a file that have the line: 7 where nothing has changed."""
        text = path.read_text(encoding="utf-8")
        squeezed, line, points = squeeze(text), squeeze(self.line), {}
        for k in (match.start() for match in re.finditer(re.escape(line), squeezed)):
            function = operators.function_at(text.encode(), path.suffix, len(text[: position(text, k)].encode()))
            points[k] = (
                2 * (function.split(".")[-1] == self.function.split(".")[-1])
                + 2 * squeezed[:k].endswith(squeeze(self.before))
                + 2 * squeezed[k + len(line) :].startswith(squeeze(self.after))
                + (path.relative_to(root).as_posix() == self.file)
            )
        return points

    def apply(self, root: Path = ROOT) -> tuple[Path, str]:
        """The file below `root` that the mutant means now, and its changed content. Raises `ValueError` as `find`."""
        path, place = self.find(root)
        text = path.read_text(encoding="utf-8")
        old, new = (re.findall(r"\s+|\w+|\W", part) for part in (self.line, self.changed))
        head = common(old, new)
        tail = common(old[head:][::-1], new[head:][::-1])
        first = place + len(squeeze("".join(old[:head])))
        count = len(squeeze("".join(old[head : len(old) - tail])))
        start = position(text, first)
        if not count and head and not old[head - 1].isspace():
            start = position(text, first - 1) + 1  # directly behind what stays
        end = position(text, first + count - 1) + 1 if count else start
        return path, text[:start] + "".join(new[head : len(new) - tail]) + text[end:]


def common(one: list[str], other: list[str]) -> int:
    """How many items at the beginning are the same."""
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(one, other, strict=False)))


def squeeze(text: str) -> str:
    """A text without spaces and line ends."""
    return "".join(text.split())


def position(text: str, k: int) -> int:
    """Index in a text of the k-th character that is no space."""
    for match in re.finditer(r"\S+", text):
        if k < len(match[0]):
            return match.start() + k
        k -= len(match[0])
    return len(text)


def sources(root: Path = ROOT) -> list[Path]:
    """Files that are mutated, in the order of their paths."""
    results = (path for folder in SOURCES for path in (root / folder).rglob("*") if path.suffix in SUFFIXES)
    return sorted(path for path in results if not NOT_MUTATED & set(path.relative_to(root).parts))


def draw(number: int, seed: int, root: Path = ROOT) -> list[Iterator[Sampled]]:
    """Random mutants, equal for equal seeds and trees.

    A room is a folder. Its share grows with the root of its size, so that small rooms are drawn too; so does the share
    of an operator in a file. Returns one for each mutant; the next of an iterator stands in for one that does not
    compile.
    """
    _changes.cache_clear()
    rooms: dict[Path, list[Path]] = {}
    for path in sources(root):
        rooms.setdefault(path.parent, []).append(path)
    weights = [math.sqrt(sum(path.stat().st_size for path in files)) for files in rooms.values()]
    start, total = random.Random(seed).random(), sum(weights)
    drawn, ends, visited = [], 0.0, set[Sampled]()
    for files, weight in zip(rooms.values(), weights, strict=True):
        first, ends = math.ceil(ends - start), ends + number * weight / total
        last = min(math.ceil(ends - start), number)
        drawn += [_stream(files, random.Random(f"{seed} {k}"), root, visited) for k in range(first, last)]
    random.Random(seed).shuffle(drawn)  # what is known of a run that was stopped is a sample too
    return drawn


def _stream(files: list[Path], chance: random.Random, root: Path, seen: set[Sampled]) -> Iterator[Sampled]:
    """Mutants of a room, or of all where it has no other."""
    for place in (files, sources(root)):
        misses = 0
        while misses < MISSES:
            misses += 1
            path = chance.choices(place, [1 + file.stat().st_size for file in place])[0]
            kinds: dict[str, list[operators.Change]] = {}
            for change in _changes(path):
                kinds.setdefault(change.operator, []).append(change)
            if not kinds:
                continue
            kind = chance.choices(list(kinds), [math.sqrt(len(found)) for found in kinds.values()])[0]
            mutant = mutant_of(path, chance.choice(kinds[kind]), root)
            if mutant is not None and mutant not in seen:
                misses = 0
                seen.add(mutant)
                yield mutant


@cache
def _changes(path: Path) -> list[operators.Change]:
    return list(operators.changes(path.read_bytes(), path.suffix))


def mutant_of(path: Path, change: operators.Change, root: Path) -> Sampled | None:
    """The mutant that makes a change; None where the result cannot be read or its place is not the only one."""
    source = path.read_bytes()
    result = source[: change.start] + change.new.encode() + source[change.end :]
    if operators.unread(result, path.suffix) > operators.unread(source, path.suffix):
        return None
    start = source.rfind(b"\n", 0, change.start) + 1
    end = source.find(b"\n", change.end)
    end = len(source) if end < 0 else end
    before, line, after = (part.decode() for part in (source[:start], source[start:end], source[end:]))
    changed = result[start : end + len(result) - len(source)].decode()
    before, after = ([*filter(str.strip, part.splitlines()), ""] for part in (before, after))
    mutant = Sampled(
        path.relative_to(root).as_posix(),
        change.function,
        change.operator,
        before[-2].strip() if len(before) > 1 else "",
        line,
        changed,
        after[0].strip(),
    )
    try:
        mutated = mutant.apply(root)
    except ValueError:
        return None
    return mutant if mutated == (path, result.decode()) else None
