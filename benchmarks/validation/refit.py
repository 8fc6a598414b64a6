"""The fit of the multibody car to the drive, by ``ali3 compare --fit`` between bounds that stand in a file."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ali3.errors import UserError
from ali3.reading import read_toml
from benchmarks.validation.drive import FITTED, LENGTH, text_of
from benchmarks.validation.multibody import LATERAL, YAW
from hosts.compare.command import main as compare

NEAR = 0.02  # of the range: a number so near to a bound is told
COLUMNS = {
    "number": "",
    "low": ".4g",
    "high": ".4g",
    "found": ".4g",
    "within": ".2g",
    "without a quarter": "",
    "without it": "+.1f",
    "near a bound": "",
}
_FIT_STEP = 0.01  # s, inner one


def refit(car: str, log: Path, aliases: Path, wanted: Path, settings: dict[str, float]) -> list[dict[str, Any]]:
    """Rows of `COLUMNS`, one for each number that is sought.

    `car`: what ``ali3 compare`` takes; `wanted`: TOML: of each number a table with ``low`` and ``high``, and one
    ``given`` of values in place of those of the car. The windows follow each other, so that each second counts once.
    Raises `UserError`: the command did not fit.
    """
    sought = read_toml(wanted, UserError)
    given = settings | sought.pop("given", {})
    ranges = {name: (float(t["low"]), float(t["high"])) for name, t in sought.items()}
    with tempfile.TemporaryDirectory() as folder:
        record = Path(folder, "record.json")
        arguments = [car, str(log), "--log-aliases", str(aliases), "--hold-speed", "--windows", f"{LENGTH:g}"]
        arguments += ["--seconds", text_of(FITTED), "--signals", f"{YAW},{LATERAL}", "--fit-step", f"{_FIT_STEP:g}"]
        arguments += [part for n, (a, b) in ranges.items() for part in ("--fit", f"{n}={a!r}:{b!r}")]
        arguments += [part for n, value in given.items() for part in ("--set", f"{n}={value!r}")]
        compare([*arguments, "--jobs", "1", "--out", folder, "--json", str(record)])
        if not record.exists():
            raise UserError("Nothing was fitted; the command has said why.")
        found = json.loads(record.read_text(encoding="utf-8"))["fit"]["found"]
    return [_row(f, *ranges[f["name"]]) for f in found]


def _row(found: dict[str, Any], low: float, high: float) -> dict[str, Any]:
    value, folds = found["value"], found["folds"]
    near = min(value - low, high - value) < NEAR * (high - low)
    return {
        "number": f"`{found['name']}`",
        "low": low,
        "high": high,
        "found": value,
        "within": found["half_width_95"],
        "without a quarter": f"{min(folds):.4g} to {max(folds):.4g}" if folds else "–",
        "without it": None if found["without"] is None else 100.0 * (found["without"] - 1.0),
        "near a bound": "yes" if near else "no",
    }


def problems(rows: Sequence[dict[str, Any]]) -> list[str]:
    """Sentences on numbers that lie near a bound."""
    return [
        f"{row['number']} = {row['found']:.4g} lies within {NEAR:.0%} of a bound; the model lacks what it stands for."
        for row in rows
        if row["near a bound"] == "yes"
    ]
