"""The fit of the multibody car to the drive, by ``ali3 compare --fit`` with bounds from a file."""

import json
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ali3.errors import UserError
from ali3.reading import read_toml
from benchmarks.validation.drive import FITTED, LENGTH, text_of
from benchmarks.validation.multibody import arguments_of
from hosts.compare.command import main as compare

BOUNDS = Path(__file__).with_name("ferrari_250_lm_fit.toml")
NEAR_BOUND = 0.02  # of the range: distance from a bound up to which a parameter is marked
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
STEP = 0.01  # inner step, s
WINDOW_INTERVAL = 10.0  # interval between the starts of windows, s


def read_ranges(file: Path) -> dict[str, str]:
    """Ranges of the fitted parameters by name, as arguments of ``--fit``. `file`: TOML, tables with ``low`` and
    ``high``.
    """
    return {n: f"{float(t['low'])!r}:{float(t['high'])!r}" for n, t in read_toml(file, UserError).items()}


def refit(car: str, log: Path, aliases: Path, bounds: Path) -> list[dict[str, Any]]:
    """Rows of `COLUMNS`, one for each fitted parameter.

    `car`: argument of ``ali3 compare``; `bounds`: file for `read_ranges`. Raises `UserError` if the command failed.
    """
    ranges = read_ranges(bounds)
    with tempfile.TemporaryDirectory() as folder:
        record = Path(folder, "record.json")
        arguments = [*arguments_of(car, log, aliases, {"step_size": STEP}), "--windows", f"{LENGTH:g}"]
        arguments += ["--window-every", f"{WINDOW_INTERVAL:g}", "--seconds", text_of(FITTED), "--jobs", "1"]
        arguments += [part for name, span in ranges.items() for part in ("--fit", f"{name}={span}")]
        compare([*arguments, "--out", folder, "--json", str(record)])
        content = json.loads(record.read_text(encoding="utf-8")) if record.exists() else {}
    if "fit" not in content:
        raise UserError("Nothing was fitted; the command has said why.")
    return [row_of(f, *map(float, ranges[f["name"]].split(":"))) for f in content["fit"]["found"]]


def row_of(fitted: dict[str, Any], low: float, high: float) -> dict[str, Any]:
    """Row of `COLUMNS`. `fitted`: entry of a record of ``ali3 compare --fit``."""
    value, folds = fitted["value"], fitted["folds"]
    near = min(value - low, high - value) < NEAR_BOUND * (high - low)
    return {
        "number": f"`{fitted['name']}`",
        "low": low,
        "high": high,
        "found": value,
        "within": fitted["half_width_95"],
        "without a quarter": f"{min(folds):.4g} to {max(folds):.4g}" if folds else "–",
        "without it": None if fitted["without"] is None else 100.0 * (fitted["without"] - 1.0),
        "near a bound": "yes" if near else "no",
    }


def bound_notes(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """Sentences on parameters near a bound."""
    return [
        f"{row['number']} = {row['found']:.4g} lies within {NEAR_BOUND:.0%} of a bound: it makes up for "
        "what the model lacks."
        for row in rows
        if row["near a bound"] == "yes"
    ]
