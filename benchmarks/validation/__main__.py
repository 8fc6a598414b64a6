"""A car against a measured drive, and published tests: ``python -m benchmarks.validation PART``.

The drive is the log of a Ferrari 250 LM on a race track (source: `docs/validation.md`), or another log with its alias
file and car. Simple models and the car are fitted to the same seconds and compared in the other seconds.
"""

import sys
import tempfile
from argparse import Namespace
from collections.abc import Sequence
from dataclasses import replace as replace_of
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ali3.errors import UserError
from benchmarks.shared.command import Part, run, watched
from benchmarks.shared.pages import DOCS, Row, table
from benchmarks.validation import margins, omitted_seconds, published_tests, two_track
from benchmarks.validation.bank import bank_of, write_banked
from benchmarks.validation.bicycle import MODELS, Body
from benchmarks.validation.chart import draw
from benchmarks.validation.curves import MIN_SECONDS, acceleration_error, curves, within
from benchmarks.validation.drive import FITTED, JUDGED, Array, Drive, Spans, read_drive
from benchmarks.validation.fitting import Fitted, fit
from benchmarks.validation.multibody import DriveComparison, compare_drive
from benchmarks.validation.published_figures import full_throttle, published_rows
from benchmarks.validation.refit import BOUNDS, bound_notes, refit
from benchmarks.validation.refit import COLUMNS as FIT_COLUMNS

ALIASES = Path(__file__).with_name("ferrari_250_lm_log.toml")
PAGE = "validation.md"
BODY = Body(
    982.0, 1605.0, 1.33, 1.07, 0.55
)  # data of the publication that the car file names; inertia of a box with the size of the car
FITTED_NUMBERS = 6  # marked [F] in the file of the car
MODEL_COLUMNS = {
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
AIMS = {"understeer angle": 0.3, "sideslip": 0.5}  # deg, largest mean difference in a bin
PARTS_LEFT_OUT = (
    ("steering a quarter as stiff", {"steering.stiffness": 125.0}),
    ("without anti-roll bars", {"front.anti_roll_bar.factor": 0.02, "rear.anti_roll_bar.factor": 0.02}),
    ("open differential", {"drive.locking": 0.0}),
    ("brakes alike on both sides", {"brakes.side": 0.0}),
    ("without the driver, who sits on the right", {"payload.driver.mass": 0.0}),
    ("inner steps of 10 ms", {"step_size": 0.01}),
)
LACKING = {k: f for k, f in MODEL_COLUMNS.items() if k in ("model", "windows", "lateral", "departed")}
PUBLISHED = {"test": "", "published": "", "read within": "g", "car": ".2f", "verdict": ""}
FOLDS = {"number": "", "fitted seconds": ".4g", "others": ".4g"}
STEP = 0.005  # inner step of the car, s
COARSE_STEP = 0.01  # inner step for many runs, s
LEFT_OUT = "linear bicycle", "saturating bicycle, tanh", "x/sqrt(1 + x2), two grips, yaw inertia"
BANKED = "multibody car, bank by place"
CHART_MODEL = 3  # index in MODELS: the saturating bicycle with four numbers
COLUMNS = {
    "models": MODEL_COLUMNS,
    "parts": LACKING,
    "published": PUBLISHED,
    "curves": {"quantity": "", "ay, g": "+.1f", "seconds": ".1f", "measured": ".2f", "spread": ".2f"},
    "folds": FOLDS,
    "numbers": {"model": "", "found": "", "starts": ""},
    "notes": {"note": ""},
}


def _drive(options: Namespace) -> list[dict[str, Any]]:
    """Fit the models and compare them; rows with the names of their tables."""
    log, aliases = _log(options)
    page = (DOCS / PAGE).read_text(encoding="utf-8")
    if options.write and options.banked_car is None and f"| {BANKED} |" in page:
        raise UserError(
            f"The page has the row '{BANKED}', which --write without --banked-car FMU would lose; give it too."
        )
    drive = _with_bank(read_drive(log, aliases), FITTED)
    models = [m for m in (*MODELS, *two_track.MODELS) if drive.bank.size or not m.bank]
    fits = [fit(model, BODY, drive) for model in watched(models)]

    def compare_car(settings: dict[str, float], brief: bool) -> DriveComparison:
        return compare_drive(options.car, log, aliases, {"step_size": STEP} | settings, brief)

    car = compare_car({}, brief=False)
    rows = [_row_of_fit(f, drive) for f in fits] + [_row_of_car("multibody car", car, FITTED_NUMBERS, drive)]
    if options.banked_car is not None and drive.bank.size:
        with tempfile.TemporaryDirectory() as folder:
            files = write_banked(Path(folder), log, aliases, drive.bank, BODY.mass)
            banked = compare_drive(str(options.banked_car), *files, {"step_size": STEP})
        rows.append(_row_of_car(BANKED, banked, FITTED_NUMBERS, drive))
    best = min((f for f in fits if np.isfinite(f.lateral)), key=lambda f: f.windows)
    refitted = fit(best.model, BODY, _with_bank(drive, JUDGED), JUDGED, FITTED)
    tables = {
        "models": rows,
        "parts": [_row_of_car(name, compare_car(values, brief=True), 0, drive) for name, values in PARTS_LEFT_OUT],
        "published": published_rows(*full_throttle(options.car, {"step_size": STEP})),
        "curves": _curves({"multibody car": car.predicted, best.model.name: best.predicted}, drive),
        "folds": _folds(best, refitted),
        "numbers": _numbers(fits),
        "notes": [{"note": note} for note in car.notes],
    }
    if options.picture is not None:
        chosen = fits[CHART_MODEL]
        draw(drive, car.time, car.path, chosen.path, chosen.model.name, options.picture)
    return [{"table": name, **row} for name, table_rows in tables.items() for row in table_rows]


def _kinds(options: Namespace) -> list[dict[str, Any]]:
    log, aliases = _log(options)
    models = [*(m for m in MODELS if m.name in LEFT_OUT), two_track.MODELS[1]]
    car = options.car, log, aliases, {"step_size": COARSE_STEP}, options.bounds or BOUNDS
    return omitted_seconds.rows_of(models, BODY, read_drive(log, aliases), car)


def _log(options: Namespace) -> tuple[Path, Path]:
    """The log and its alias file."""
    if options.log is None:
        raise UserError("The log of the drive is given by --log FILE.")
    return options.log, options.aliases or ALIASES


def _with_bank(drive: Drive, seconds: Spans) -> Drive:
    """The drive with the bank of the road from its accelerometer in some seconds; unchanged if it cannot be
    computed.
    """
    try:
        return replace_of(drive, bank=bank_of(drive, seconds))
    except ValueError as error:
        print(f"note: no bank of the road, and no model that knows it. {error}")
        return drive


def _row_of_fit(f: Fitted, drive: Drive) -> dict[str, Any]:
    lateral = None if np.isnan(f.lateral) else f.lateral
    return {
        "model": f.model.name, "numbers": len(f.numbers), "fitted": f.fitted, "windows": f.windows, "whole": f.whole,
        "lateral": lateral, **_by_acceleration(drive, f.predicted), "departed": str(f.departed),
    }  # fmt: skip


def _by_acceleration(drive: Drive, predicted: tuple[Array, Array]) -> dict[str, Any]:
    """Error of the lateral acceleration, m/s2, and the number of bins whose means are within `AIMS`."""
    if np.isnan(predicted[0]).any():
        return {"acceleration": None, "understeer": "–", "sideslip": "–"}
    result = curves(drive, BODY.wheelbase, *predicted)
    counts = {quantity: within(result, quantity, aim) for quantity, aim in AIMS.items()}
    agreement = {quantity.split()[0]: f"{good} of {total}" for quantity, (good, total) in counts.items()}
    return {"acceleration": acceleration_error(drive, *predicted), **agreement}


def _curves(models: dict[str, tuple[Array, Array]], drive: Drive) -> list[dict[str, Any]]:
    """Rows of understeer angle and sideslip by lateral acceleration: measured mean, and difference of each model."""
    results = {name: curves(drive, BODY.wheelbase, *predicted) for name, predicted in models.items()}
    rows = []
    for k, c in enumerate(next(iter(results.values()))):
        row: dict[str, Any] = {
            "quantity": c.quantity,
            "ay, g": c.acceleration,
            "seconds": c.seconds,
            "measured": c.measured,
        }
        rows.append(
            row | {"spread": c.spread} | {name: model_curves[k].difference for name, model_curves in results.items()}
        )
    return [row for row in rows if row["seconds"] >= MIN_SECONDS]


def _folds(first: Fitted, second: Fitted) -> list[dict[str, Any]]:
    """Rows of the parameters of a model fitted to either part of the drive, and of its yaw-rate error in the other."""
    rows = [
        {"number": f"{u.name}, {u.unit}", "fitted seconds": a, "others": b}
        for (u, a), (_, b) in zip(_unknowns_with_values(first), _unknowns_with_values(second), strict=True)
    ]
    yaw_rate_row = {
        "number": "yaw rate in windows of the other part, rad/s",
        "fitted seconds": first.windows,
        "others": second.windows,
    }
    return [*rows, yaw_rate_row]


def _row_of_car(name: str, comparison: DriveComparison, numbers: int, drive: Drive) -> dict[str, Any]:
    return {
        "model": name,
        "numbers": numbers,
        "fitted": None if np.isnan(comparison.fitted) else comparison.fitted,
        "windows": comparison.windows,
        "whole": None if np.isnan(comparison.whole) else comparison.whole,
        "lateral": comparison.lateral,
        **_by_acceleration(drive, comparison.predicted),
        "departed": ", ".join(comparison.departed) or "0",
    }


def _numbers(fits: Sequence[Fitted]) -> list[dict[str, Any]]:
    """Rows of the fitted parameters of each simple model, and of the deviation from each start."""
    return [
        {
            "model": f.model.name,
            "found": ", ".join(f"{u.name} {x:.4g} {u.unit}".rstrip("1").rstrip() for u, x in _unknowns_with_values(f)),
            "starts": ", ".join(f"{x:.4f}" for x in sorted(f.deviations)),
        }
        for f in fits
        if len(f.numbers)
    ]


def _unknowns_with_values(f: Fitted) -> list[tuple[Any, float]]:
    return list(zip(f.model.unknowns, f.numbers.tolist(), strict=True))


def blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Tables of the page by the names of their marks."""
    rows_of = {
        name: [{k: v for k, v in r.items() if k != "table"} for r in rows if r["table"] == name] for name in COLUMNS
    }
    form = COLUMNS["curves"] | dict.fromkeys(list(rows_of["curves"][0])[5:], ".2f")
    tables = {
        name: table(rows_of[name], COLUMNS[name]) for name in ("models", "parts", "published", "folds", "numbers")
    }
    notes = "\n".join(f"- {row['note']}" for row in rows_of["notes"])
    return tables | {"curves": table(rows_of["curves"], form), "notes": notes}


LOGGED: dict[str, tuple[Any, str]] = {
    "log": (Path, "CSV, perhaps packed (.csv.gz)"),
    "car": ("ferrari_250_lm", "FMU or car"),
    "aliases": (Path, "aliases of the log, for the car; by default the Ferrari's"),
}
FITTED_PARAMETERS: dict[str, tuple[Any, str]] = {
    "bounds": (Path, "sought parameters and their bounds; by default the Ferrari's")
}
PARTS = {
    "drive": Part(
        "simple models and the multibody car through a measured drive",
        _drive,
        COLUMNS,
        options=LOGGED
        | {
            "banked_car": (Path, "FMU of the car with --ports forces=vehicle: driven with the bank of the road too"),
            "picture": (Path, "draw measured and predicted yaw rate (PNG)"),
        },
        pages=(PAGE,),
        blocks=blocks,
    ),
    "fit": Part(
        "fit the multibody car to the drive",
        lambda options: refit(options.car, *_log(options), options.bounds or BOUNDS),
        options=LOGGED | FITTED_PARAMETERS,
        words=lambda rows: table(rows, FIT_COLUMNS),
        check=lambda rows, options: bound_notes(rows),
    ),
    "margins": Part(
        "how near the multibody car is to a spin: starts beside the measured state, more speed",
        lambda options: margins.margins(options.car, *_log(options), {"step_size": COARSE_STEP}),
        options=LOGGED,
        pages=(PAGE,),
        blocks=lambda rows: {"margins": table(rows, margins.COLUMNS)},
    ),
    "kinds": Part(
        "what models predict for kinds of seconds that are left out: corners, speeds, accelerations",
        _kinds,
        options=LOGGED | FITTED_PARAMETERS,
        pages=(PAGE,),
        blocks=lambda rows: {"kinds": table(rows, omitted_seconds.COLUMNS)},
    ),
    "others": Part(
        "figures that others published of cars and tyres, with what the cars here do",
        lambda options: published_tests.rows(),
        published_tests.COLUMNS,
        pages=(PAGE,),
        blocks=lambda rows: {"others": table(rows, published_tests.COLUMNS)},
    ),
}

main = partial(run, "validation", __doc__, PARTS)

if __name__ == "__main__":
    sys.exit(main())
