"""A car against its measured drive: ``python -m benchmarks.validation FILE [--json FILE] [--page] [--chart FILE]``.

Without FILE: the tests of others alone (``python -m benchmarks.validation [--json FILE] [--page]``).

FILE is the log of a Ferrari 250 LM on a race track (see `docs/validation.md` for where it comes from), or another log
with its alias file and car. Simple models are fitted on the same seconds as the car was, and all are judged on others.
"""

from __future__ import annotations

import sys
import tempfile
from argparse import Namespace
from collections.abc import Sequence
from dataclasses import replace as replace_of
from pathlib import Path
from typing import Any

import numpy as np

from ali3.files import write_text
from ali3.running import run_command
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.pages import DOCS, replace, table
from benchmarks.shared.tables import print_table
from benchmarks.validation import others, two_track
from benchmarks.validation.bank import bank_of
from benchmarks.validation.banked_log import write_banked
from benchmarks.validation.bicycle import MODELS, Body
from benchmarks.validation.chart import draw
from benchmarks.validation.curves import ENOUGH, acceleration_error, curves, within
from benchmarks.validation.drive import FITTED, JUDGED, Array, Drive, Spans, read_drive
from benchmarks.validation.fitting import Fitted, fit
from benchmarks.validation.multibody import LATERAL, YAW, Judged, judge
from benchmarks.validation.published import full_throttle, published_rows

HERE = Path(__file__).parent
PAGE = DOCS / "validation.md"
BODY = Body(
    982.0, 1605.0, 1.33, 1.07, 0.55
)  # of the publication that the car file names; inertia of a box of its outline
FITTED_NUMBERS = 9  # marked [F] in the file of the car
COLUMNS = {
    "model": "",
    "numbers": "d",
    "fitted": ".4f",
    "windows": ".4f",
    "whole": ".4f",
    "lateral": ".2f",
    "acceleration": ".2f",
    "understeer": "",
    "sideslip": "",
    "departed": "",
}
AIMS = {"understeer angle": 0.3, "sideslip": 0.5}  # deg, of the mean difference in a bin
PARTS = (
    ("steering a quarter as stiff", {"steering.stiffness": 122.0}),
    ("without anti-roll bars", {"front.anti_roll_bar.factor": 0.02, "rear.anti_roll_bar.factor": 0.02}),
    ("open differential", {"drive.locking": 0.0}),
    ("brakes alike on both sides", {"brakes.side": 0.0}),
    ("without the driver, who sits on the right", {"payload.driver.mass": 0.0}),
    ("inner steps of 10 ms", {"step_size": 0.01}),
)
LACKING = {k: f for k, f in COLUMNS.items() if k in ("model", "windows", "lateral", "departed")}
PUBLISHED = {"test": "", "published": "", "read within": "g", "car": ".2f", "verdict": ""}
FOLDS = {"number": "", "fitted seconds": ".4g", "others": ".4g"}
STEP = 0.005  # s, inner one of the car
BANKED = "multibody car, bank by place"
CHART_MODEL = 3  # of MODELS: the saturating bicycle with four numbers


def main(arguments: Sequence[str] | None = None) -> int:
    """Fit, judge, print, and write what was asked for."""
    parser = parser_of("validation", __doc__, chart="measured and predicted yaw rate")
    parser.add_argument(
        "file",
        type=Path,
        nargs="?",
        metavar="FILE",
        help="log of the drive: CSV, perhaps packed (.csv.gz); without it the tests of others are made",
    )
    parser.add_argument("--car", default="ferrari_250_lm", help="FMU or car; default: %(default)s")
    parser.add_argument(
        "--log-aliases", type=Path, default=HERE / "ferrari_250_lm_log.toml", metavar="FILE", help="of the log as it is"
    )
    parser.add_argument(
        "--car-aliases", type=Path, default=HERE / "ferrari_250_lm_log.toml", metavar="FILE", help="for the car"
    )
    parser.add_argument(
        "--banked-car", metavar="FMU", help="the car with --ports forces=vehicle: driven with the bank of the road too"
    )
    parser.add_argument("--page", action="store_true", help="write the tables of docs/validation.md")
    parser.add_argument("--no-published", dest="published", action="store_false", help="without figures of others")
    parser.add_argument("--no-parts", action="store_true", help="without the cars that lack a part")
    options = parser.parse_args(arguments)
    if options.file is None:
        if options.chart or options.banked_car:
            parser.error("--chart and --banked-car need the FILE of the drive.")
        return _others(options)
    if options.page and not options.banked_car and f"| {BANKED} |" in PAGE.read_text(encoding="utf-8"):
        parser.error(f"The page has the row '{BANKED}', which --page without --banked-car FMU would lose; give it too.")
    drive = read_drive(options.file, options.log_aliases)
    drive = _banked(drive, FITTED)
    models = [m for m in (*MODELS, *two_track.MODELS) if drive.bank.size or not m.bank]
    simple = [fit(model, BODY, drive) for model in watched(models)]

    def judged(settings: dict[str, float], brief: bool) -> Judged:
        return judge(options.car, options.file, options.car_aliases, {"step_size": STEP} | settings, brief)

    car = judged({}, brief=False)
    parts = {} if options.no_parts else {name: judged(values, brief=True) for name, values in PARTS}
    rows = [_of_bicycle(f, drive) for f in simple] + [_of_car("multibody car", car, FITTED_NUMBERS, drive)]
    if options.banked_car and drive.bank.size:
        with tempfile.TemporaryDirectory() as folder:
            given = write_banked(Path(folder), options.file, options.car_aliases, drive.bank, BODY.mass)
            banked = judge(options.banked_car, *given, {"step_size": STEP})
        rows.append(_of_car(BANKED, banked, FITTED_NUMBERS, drive))
    lacking = [_of_car(name, part, 0, drive) for name, part in parts.items()]
    best = min((f for f in simple if np.isfinite(f.lateral)), key=lambda f: f.windows)
    over = _curves({"multibody car": car.predicted, best.model.name: best.predicted}, drive)
    swapped = fit(best.model, BODY, _banked(drive, JUDGED), JUDGED, FITTED)
    folds = _folds(best, swapped)
    told_of_it = published_rows(*full_throttle(options.car, {"step_size": STEP})) if options.published else []
    print_table(rows, COLUMNS)
    for told, columns in ((lacking, LACKING), (told_of_it, PUBLISHED)):
        if told:
            print_table(told, columns)
    for note in car.notes:
        print(f"note: {note}")
    record: dict[str, Any] = {"numbers": _numbers(simple), "bins": car.bins, "notes": car.notes, "parts": lacking}
    record |= {"curves": over, "published": told_of_it, "folds": folds}
    save_rows(options.json, "validation", rows, **record)
    if options.page:
        tables = blocks(rows, lacking, simple, car, over)
        tables["folds"] = table(folds, FOLDS)
        if told_of_it:
            tables["published"] = table(told_of_it, PUBLISHED)
        _merge(tables)
    if options.chart:
        chosen = simple[CHART_MODEL]
        draw(drive, car.time, car.path, chosen.path, chosen.model.name, options.chart)
    return 0


def _others(options: Namespace) -> int:
    """The tests of others, printed and merged into the page, whose other tables stay."""
    made = others.rows()
    print_table(made, others.COLUMNS)
    save_rows(options.json, "validation", made)
    if options.page:
        _merge({"others": table(made, others.COLUMNS)})
    return 0


def _merge(tables: dict[str, str]) -> None:
    """Exchange these tables of the page."""
    write_text(PAGE, replace(PAGE.read_text(encoding="utf-8"), tables))


def _banked(drive: Drive, seconds: Spans) -> Drive:
    """With the bank of the road from the accelerometer of some seconds; as it is where that cannot tell it."""
    try:
        return replace_of(drive, bank=bank_of(drive, seconds).by_place)
    except ValueError as error:
        print(f"note: no bank of the road, and no model that knows it. {error}")
        return drive


def _of_bicycle(f: Fitted, drive: Drive) -> dict[str, Any]:
    lateral = None if np.isnan(f.lateral) else f.lateral
    return {
        "model": f.model.name, "numbers": len(f.numbers), "fitted": f.fitted, "windows": f.windows, "whole": f.whole,
        "lateral": lateral, **_by_acceleration(drive, f.predicted), "departed": str(f.departed),
    }  # fmt: skip


def _by_acceleration(drive: Drive, predicted: tuple[Array, Array]) -> dict[str, Any]:
    """Deviation of the lateral acceleration, and in how many bins the means are within `AIMS`."""
    if np.isnan(predicted[0]).any():
        return {"acceleration": None, "understeer": "–", "sideslip": "–"}
    found = curves(drive, BODY.wheelbase, *predicted)
    counts = {quantity: within(found, quantity, aim) for quantity, aim in AIMS.items()}
    told = {quantity.split()[0]: f"{good} of {of}" for quantity, (good, of) in counts.items()}
    return {"acceleration": acceleration_error(drive, *predicted), **told}


def _curves(models: dict[str, tuple[Array, Array]], drive: Drive) -> list[dict[str, Any]]:
    """Understeer angle and sideslip by lateral acceleration: what was measured, and how far each model is off."""
    found = {name: curves(drive, BODY.wheelbase, *predicted) for name, predicted in models.items()}
    rows = []
    for k, c in enumerate(next(iter(found.values()))):
        row: dict[str, Any] = {
            "quantity": c.quantity,
            "ay, g": c.acceleration,
            "seconds": c.seconds,
            "measured": c.measured,
        }
        rows.append(row | {"spread": c.spread} | {name: own[k].difference for name, own in found.items()})
    return [row for row in rows if row["seconds"] >= ENOUGH]


def _folds(one: Fitted, other: Fitted) -> list[dict[str, Any]]:
    """The numbers of a model that was fitted to either part of the drive, and its yaw rate over the other part."""
    rows = [
        {"number": f"{u.name}, {u.unit}", "fitted seconds": a, "others": b}
        for (u, a), (_, b) in zip(_named(one), _named(other), strict=True)
    ]
    told = {
        "number": "yaw rate in windows of the other part, rad/s",
        "fitted seconds": one.windows,
        "others": other.windows,
    }
    return [*rows, told]


def _of_car(name: str, j: Judged, numbers: int, drive: Drive) -> dict[str, Any]:
    return {
        "model": name,
        "numbers": numbers,
        "fitted": None if np.isnan(j.fitted) else j.fitted,
        "windows": j.windows,
        "whole": None if np.isnan(j.whole) else j.whole,
        "lateral": j.lateral,
        **_by_acceleration(drive, j.predicted),
        "departed": ", ".join(j.departed) or "0",
    }


def _numbers(simple: Sequence[Fitted]) -> list[dict[str, Any]]:
    """What was fitted to each simple model, and what each start of the fit found."""
    return [
        {
            "model": f.model.name,
            "found": ", ".join(f"{u.name} {x:.4g} {u.unit}".rstrip("1").rstrip() for u, x in _named(f)),
            "starts": ", ".join(f"{x:.4f}" for x in sorted(f.found)),
        }
        for f in simple
        if len(f.numbers)
    ]


def _named(f: Fitted) -> list[tuple[Any, float]]:
    return list(zip(f.model.unknowns, f.numbers.tolist(), strict=True))


def blocks(
    rows: Sequence[dict[str, Any]],
    lacking: Sequence[dict[str, Any]],
    simple: Sequence[Fitted],
    car: Judged,
    over: Sequence[dict[str, Any]],
) -> dict[str, str]:
    """The tables of the page by their marks."""
    by = {}
    for quantity in ("speed", "lateral acceleration"):
        told = [b for b in car.bins if b["quantity"] == quantity]
        lines = []
        for low, high, unit in sorted({(b["low"], b["high"], b["unit"]) for b in told}):
            of = {b["signal"]: b for b in told if b["low"] == low}
            lines.append(
                {
                    f"{quantity}, {unit}": f"{low:g} to {high:g}",
                    "samples": of[YAW]["samples"],
                    "yaw rate, rms": of[YAW]["rms"],
                    "yaw rate, mean": of[YAW]["mean"],
                    "lateral velocity, rms": of[LATERAL]["rms"],
                    "lateral velocity, mean": of[LATERAL]["mean"],
                }
            )
        if lines:
            keys = list(lines[0])
            by[quantity] = table(
                lines,
                {keys[0]: "", keys[1]: "d", **dict.fromkeys(keys[2:4], "+.4f"), **dict.fromkeys(keys[4:], "+.2f")},
            )
    keys = list(over[0])
    form = {keys[0]: "", keys[1]: "+.1f", keys[2]: ".1f", **dict.fromkeys(keys[3:], ".2f")}
    return {
        "curves": table(over, form),
        "models": table(rows, COLUMNS),
        "parts": table(lacking, LACKING),
        "numbers": table(_numbers(simple), {"model": "", "found": "", "starts": ""}),
        **{f"by {quantity}": text for quantity, text in by.items()},
        "notes": "\n".join(f"- {note}" for note in car.notes),
    }


if __name__ == "__main__":
    sys.exit(run_command(main))
