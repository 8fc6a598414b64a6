"""Prints the levels of a car and the cheapest one within tolerances: the work of ``ali3 car CAR --cheapest``."""

import argparse
import sys
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ali3.columns import in_columns
from ali3.decimal_number import parse_number
from ali3.errors import UserError
from ali3.files import write_json
from ali3.message_text import brief, word_list
from ali3.near_names import did_you_mean
from ali3.units import number_with_unit
from ali3.warning_lines import warning_lines
from mbs.common.progress import progress_for
from mbs.vehicle.fidelity import Fidelity
from mbs.vehicle.levels.drives import default_drives, read_drive
from mbs.vehicle.levels.level_choice import OMISSIONS, LevelChoice, cheapest, levels, nearest
from mbs.vehicle.levels.measure import REFERENCE_STEP, compile_fidelities, measure
from mbs.vehicle.read_car import load

DEFAULT_TOLERANCES = {"path": 1.0, "loads": 3.0}
"""Percent."""
OUTPUTS = {"path": "path", "loads": "load", "moments": "moment"}
"""Key of an error in a row by its name in the command line."""
TITLES = {"path": "of the path", "load": "of the wheel loads", "moment": "of the moments in the frame"}


def report(options: argparse.Namespace) -> int:
    """Measure the levels, print their table and the cheapest one, write the JSON file; returns the exit code."""
    tolerances, file, speed = parse_options(options.cheapest)
    with warning_lines():
        car = load(options.car)
    if "moment" in tolerances and Fidelity.QUASI_STATIC not in car.fidelities():
        raise UserError(f"The car '{car.name}' has no moments in a frame: it has no flexible one. Leave moments out.")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        systems = compile_fidelities(car)
    for warning in caught:
        print(f"note: {warning.message}", file=sys.stderr)
    rigid = systems[Fidelity.RIGID]
    names = {entry["name"] for entry in rigid.meta["inputs"]}
    drives = default_drives(rigid) if file is None else [read_drive(file, speed, names)]
    with progress_for(None) as bar:
        rows = measure(systems, drives, tell=bar.update)
    finest = list(systems)[-1]
    _print_rows(f"{car.name}: errors against fidelity {finest.value}", [drive.name for drive in drives], rows)
    try:
        choice = cheapest(rows, tolerances)
    except ValueError:
        choice = None
    if options.json:
        content = {
            "car": car.name,
            "reference": {"fidelity": finest.value, "h_s": REFERENCE_STEP},
            "tolerances": tolerances,
            "cheapest": None if choice is None else {"fidelity": choice.fidelity.value, "h_s": choice.h},
            "rows": [row | {"fidelity": Fidelity.of(row["fidelity"]).value} for row in rows],
        }
        write_json(options.json, content)
    if choice is None:
        raise UserError(_failure_sentence(rows, tolerances))
    print("\n" + _choice_sentence(choice, tolerances))
    return 0


def _print_rows(title: str, drives: Sequence[str], rows: Sequence[Mapping[str, Any]]) -> None:
    """Print the table of the levels, and why runs ended early."""
    print(f"{title} with steps of {1e3 * REFERENCE_STEP:g} ms, the largest of: {', '.join(drives)}\n")
    print("\n".join(table(rows)))
    for row in rows:
        if row["failed"]:
            label = f"{row['manoeuvre']}, fidelity {Fidelity.of(row['fidelity']).value}, {1e3 * row['h_s']:g} ms"
            print(f"note: {label}: {row['failed']}", file=sys.stderr)


def parse_options(words: Sequence[tuple[str, str]]) -> tuple[dict[str, float], Path | None, float]:
    """Tolerances (ratios by error), file of a drive and its initial speed (m/s) from the NAME=VALUE of the option.

    Raises `UserError` if a name is not known, or a value cannot be used.
    """
    options = dict(words)
    numbers = {name: text for name, text in options.items() if name != "drive"}
    unknown = [name for name in numbers if name not in (*OUTPUTS, "speed")]
    if unknown:
        raise UserError(
            f"--cheapest takes {', '.join(OUTPUTS)}, drive and speed, each as NAME=VALUE, not {brief(unknown[0])}"
            f"{did_you_mean(unknown[0], [*OUTPUTS, 'drive', 'speed'])}"
        )
    values: dict[str, float] = dict(DEFAULT_TOLERANCES)
    for name, text in numbers.items():
        try:
            values[name] = number_with_unit(text, "m/s") if name == "speed" else parse_number(text.removesuffix("%"))
        except ValueError as error:
            raise UserError(f"{name} of --cheapest: {error}.") from None
        if name != "speed" and not values[name] > 0.0:
            raise UserError(f"{name} of --cheapest is {values[name]:g}; it is in percent and must be positive.")
    if "speed" in values and "drive" not in options:
        raise UserError("speed of --cheapest is that at the start of a drive; give drive=FILE too.")
    speed = values.pop("speed", 0.0)
    tolerances = {OUTPUTS[name]: 0.01 * percent for name, percent in values.items()}
    return tolerances, Path(options["drive"]) if "drive" in options else None, speed


def table(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """Lines of the table: for each level its largest errors and the processor time of its slowest drive."""
    lines: list[tuple[str, ...]] = [
        ("fidelity", "step, ms", "path, %", "loads, %", "moments, %", "ms per s", "times real time")
    ]
    for name, h in dict.fromkeys((row["fidelity"], row["h_s"]) for row in rows):
        level_rows = [row for row in rows if (row["fidelity"], row["h_s"]) == (name, h)]
        errors = [_largest_text(level_rows, output, 100.0, ".2g") for output in TITLES]
        cost = _largest_text(level_rows, "us_per_step", 1e-3 / h, ".1f")
        real = "-" if cost == "-" else f"{1e3 / max(1e-3 * row['us_per_step'] / h for row in level_rows):.0f}"
        lines.append((f"{Fidelity.of(name).value:>3} {name}", f"{1e3 * h:g}", *errors, cost, real))
    return in_columns(lines, range(1, 7))


def _largest_text(rows: Sequence[Mapping[str, Any]], key: str, factor: float, form: str) -> str:
    """Largest value of a key times a factor; a dash if a row has none."""
    values = [row[key] for row in rows]
    return "-" if None in values else format(factor * max(values), form)


def _tolerance_text(tolerances: Mapping[str, float]) -> str:
    """Tolerances in words."""
    return word_list([f"{100.0 * most:g} % {TITLES[output]}" for output, most in tolerances.items()])


def _choice_sentence(choice: LevelChoice, tolerances: Mapping[str, float]) -> str:
    """Sentence on the cheapest level."""
    return (
        f"Cheapest within {_tolerance_text(tolerances)}: fidelity {choice.fidelity.value} with steps of "
        f"{1e3 * choice.h:g} ms, {choice.ms_per_second:.1f} ms of processor time a simulated second "
        f"({1e3 / choice.ms_per_second:.0f} times real time). It leaves out {OMISSIONS[choice.fidelity]}."
    )


def _failure_sentence(rows: Sequence[Mapping[str, Any]], tolerances: Mapping[str, float]) -> str:
    """Sentence on the nearest level if none is within the tolerances."""
    measured = levels(rows, list(tolerances))
    if not measured:
        return (
            f"No level is within {_tolerance_text(tolerances)}: no run of a level with these outputs reached its end."
        )
    closest = nearest(measured, tolerances)
    errors = ", ".join(f"{100.0 * closest.errors[output]:.2g} % {TITLES[output]}" for output in tolerances)
    return (
        f"No level is within {_tolerance_text(tolerances)}; the nearest is fidelity {closest.fidelity.value} with "
        f"steps of {1e3 * closest.h:g} ms, {errors}. Give a larger tolerance, or take steps shorter than "
        f"{1e3 * min(c.h for c in measured):g} ms."
    )
