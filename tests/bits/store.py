"""The stored baseline: a hash of every signal, and numbers to estimate the size of a difference.

A signal is an array of numbers with a name. Its hash is that of its little-endian float64 bytes, so that -0.0 and 0.0
differ, with every NaN as one. Beside it stand two projections on fixed random signs, divided by the root of the count:
the root mean square of their change estimates that of the signal. Its range is stored in single precision.
"""

from __future__ import annotations

import base64
import hashlib
import json
import math
import struct
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

BASELINE = Path(__file__).with_name("baseline.json")
RELATIVE = 1e-9
ABSOLUTE = 1e-12
"""Tolerances of entries that are not compared by bits: LAPACK and optimisers round differently on other processors."""
_FORMAT = struct.Struct("<6sddff")  # hash, projections, smallest, largest
_NAN = struct.pack("<d", math.nan)


@dataclass(frozen=True)
class Signal:
    """Stored data of a signal."""

    digest: bytes
    """One byte of a BLAKE2 hash of the shape, five of one of the numbers."""
    projections: tuple[float, float]
    """Sums of the numbers with random signs, over the root of their count. What is not finite counts as 0."""
    low: float
    high: float
    """`low`, `high`: smallest and largest finite number; NaN where there is none."""

    @classmethod
    def of(cls, values: ArrayLike) -> Signal:
        """The signal of an array of numbers."""
        x = np.array(values, dtype="<f8")
        shape, x = x.shape, x.ravel()
        nan = np.isnan(x)
        x[nan] = struct.unpack("<d", _NAN)[0]
        digest = b"".join(
            hashlib.blake2b(data, digest_size=size).digest()
            for data, size in ((repr(shape).encode(), 1), (x.tobytes(), 5))
        )
        finite = x[np.isfinite(x)]
        x[~np.isfinite(x)] = 0.0
        with np.errstate(over="ignore", invalid="ignore"):
            sums = [float((x * sign).sum() / math.sqrt(max(len(x), 1))) for sign in _signs(len(x))]
        low, high = (float(finite.min()), float(finite.max())) if len(finite) else (math.nan, math.nan)
        return cls(digest, (sums[0], sums[1]), *(_single(v) for v in (low, high)))

    def text(self) -> str:
        """The data in base64."""
        return base64.b64encode(_FORMAT.pack(self.digest, *self.projections, self.low, self.high)).decode()

    @classmethod
    def from_text(cls, text: str) -> Signal:
        """The inverse of `text`."""
        digest, one, two, low, high = _FORMAT.unpack(base64.b64decode(text, validate=True))
        return cls(digest, (one, two), low, high)

    @property
    def size(self) -> float:
        """Largest absolute value, 0 where no number is finite."""
        return 0.0 if math.isnan(self.low) else max(abs(self.low), abs(self.high))

    def distance(self, other: Signal) -> float:
        """Estimate of the root mean square of the difference, and at least the change of the ends of the range."""
        a, b = (other.projections[k] - self.projections[k] for k in (0, 1))
        ends = [abs(y - x) for x, y in ((self.low, other.low), (self.high, other.high))]
        moved = max((e for e in ends if e > 1e-6 * self.size), default=0.0)  # single precision
        return max(math.hypot(a, b) / math.sqrt(2.0), moved)


Entry = tuple[bool, dict[str, Signal]]
"""Whether bits are compared, and the signals by name."""


@dataclass(frozen=True)
class Difference:
    """A signal that differs from the stored one."""

    entry: str
    signal: str
    """`entry`, `signal`: names; an empty signal: the whole entry."""
    kind: str
    """"differs", "missing" or "new"."""
    distance: float = math.nan
    relative: float = math.nan
    """`distance`, `relative`: of one that differs: absolute, and over the width of its range, or over its largest value
    where it is constant."""


def entry_of(signals: Mapping[str, ArrayLike], exact: bool = True) -> Entry:
    """An entry of arrays of numbers by name."""
    return exact, {name: Signal.of(values) for name, values in signals.items()}


def compare(stored: Mapping[str, Entry], found: Mapping[str, Entry], whole: bool = True) -> list[Difference]:
    """What differs, in the order of the names.

    Parameters
    ----------
    stored, found : mapping of str to entry
    whole : bool
        Whether what is stored and not found is missing.
    """
    rows: list[Difference] = []
    for name in sorted(stored.keys() | found.keys() if whole else found.keys()):
        if name not in stored or name not in found:
            rows.append(Difference(name, "", "new" if name not in stored else "missing"))
            continue
        exact, old = stored[name]
        new = found[name][1]
        for signal in sorted(old.keys() | new.keys()):
            if signal not in old or signal not in new:
                rows.append(Difference(name, signal, "new" if signal not in old else "missing"))
            elif old[signal].digest != new[signal].digest:
                row = _difference(name, signal, old[signal], new[signal])
                shaped = old[signal].digest[0] != new[signal].digest[0]
                if exact or shaped or not row.distance <= max(ABSOLUTE, RELATIVE * old[signal].size):
                    rows.append(row)
    return rows


def write(entries: Mapping[str, Entry], versions: Mapping[str, str], path: Path = BASELINE) -> None:
    """Write the baseline: a line for each entry, and lists of names that several entries share once.

    Parameters
    ----------
    entries : mapping of str to entry
    taken : mapping of str to str
        With what it was taken.
    path : Path
        File to write.
    """
    known, lists = {}, {}
    lines = []
    for name, (exact, signals) in sorted(entries.items()):
        key = hashlib.blake2b("\n".join(signals).encode(), digest_size=4).hexdigest()
        lists[key] = list(signals)
        for signal in signals.values():
            known[_key(signal)] = signal.text()
        content = {"bits": exact, "names": key, "signals": " ".join(_key(signal) for signal in signals.values())}
        lines.append(f"{json.dumps(name)}: {json.dumps(content)}")
    parts = {
        "entries": lines,
        "names": [f"{json.dumps(key)}: {json.dumps(names)}" for key, names in sorted(lists.items())],
        "numbers": [f"{json.dumps(key)}: {json.dumps(text[8:])}" for key, text in sorted(known.items())],
    }
    body = [f'"taken": {json.dumps(versions)}']
    body += [f'"{part}": {{\n' + ",\n".join(rows) + "\n}" for part, rows in parts.items()]
    path.write_text("{\n" + ",\n".join(body) + "\n}\n", encoding="utf-8")


def read(path: Path = BASELINE) -> tuple[dict[str, Entry], dict[str, str]]:
    """Entries and with what they were taken, as `write` wrote them."""
    data = json.loads(path.read_text(encoding="utf-8"))
    known = {key: Signal.from_text(key + text) for key, text in data["numbers"].items()}
    entries = {
        name: (
            content["bits"],
            dict(zip(data["names"][content["names"]], map(known.get, content["signals"].split()), strict=True)),
        )
        for name, content in data["entries"].items()
    }
    return entries, data["taken"]


def to_json(entries: Iterable[tuple[str, Entry]]) -> str:
    """Entries as the processes that make them hand them over."""
    return json.dumps({n: [exact, {k: s.text() for k, s in signals.items()}] for n, (exact, signals) in entries})


def from_json(text: str) -> dict[str, Entry]:
    """What `to_json` wrote."""
    return {
        name: (exact, {k: Signal.from_text(s) for k, s in signals.items()})
        for name, (exact, signals) in json.loads(text).items()
    }


def _key(signal: Signal) -> str:
    return signal.text()[:8]  # six bytes


def _difference(entry: str, signal: str, old: Signal, new: Signal) -> Difference:
    distance = old.distance(new)
    width = max(old.high - old.low, new.high - new.low, 0.0)
    scale = width if width > 1e-6 * old.size else max(old.size, new.size)
    return Difference(entry, signal, "differs", distance, distance / scale if scale else 0.0)


def _single(value: float) -> float:
    with np.errstate(over="ignore"):
        return float(np.float32(value))


@cache
def _signs(count: int) -> NDArray[np.float64]:
    """Two rows of 1 and -1, the same on every machine."""
    octets = np.frombuffer(hashlib.shake_128(b"signs").digest(2 * count), np.uint8)
    return np.where(octets & 1, 1.0, -1.0).reshape(2, count)
