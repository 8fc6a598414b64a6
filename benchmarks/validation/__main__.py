"""A car against a measured drive, and published tests: ``python -m benchmarks.validation PART``.

The drive is the log of a Ferrari 250 LM on a race track (source: `docs/validation.md`), or another log with its alias
file and car. Simple models and the car are fitted to the same seconds and compared in the other seconds.
"""

import sys
from argparse import Namespace
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ali3.errors import UserError
from benchmarks.shared.command import Part, run, watched
from benchmarks.shared.pages import Row, table
from benchmarks.validation import omitted_seconds, published_tests, two_track
from benchmarks.validation.bicycle import MODELS, Body
from benchmarks.validation.chart import draw
from benchmarks.validation.curves import ENOUGH, acceleration_error, curves, within
from benchmarks.validation.drive import Array, Drive, read_drive
from benchmarks.validation.fitting import Fitted, fit
from benchmarks.validation.multibody import DriveComparison, compare_drive
from benchmarks.validation.published_figures import full_throttle, published_rows
from benchmarks.validation.refit import BOUNDS, problems, refit
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
STEP = 0.005  # inner step of the car, s
COARSE = 0.01  # inner step for many runs, s
LEFT_OUT = "linear bicycle", "saturating bicycle, tanh", "x/sqrt(1 + x2), two grips, yaw inertia"
CHART_MODEL = 3  # index in MODELS: the saturating bicycle with four numbers
COLUMNS = {
    "models": MODEL_COLUMNS,
    "parts": LACKING,
    "published": PUBLISHED,
    "curves": {
        "quantity": "",
        "ay, g": "+.1f",
        "seconds": ".1f",
        "measured": ".2f",
        "spread": ".2f",
        "multibody car": ".2f",
    },
    "notes": {"note": ""},
}


def _drive(options: Namespace) -> list[dict[str, Any]]:
    """Fit the models and compare them; rows with the names of their tables."""
    log, aliases = _log(options)
    drive = read_drive(log, aliases)
    models = [*MODELS, two_track.MODEL]
    fits = [fit(model, BODY, drive) for model in watched(models)]

    def compare_car(settings: dict[str, float], brief: bool) -> DriveComparison:
        return compare_drive(options.car, log, aliases, {"step_size": STEP} | settings, brief)

    car = compare_car({}, brief=False)
    rows = [_row_of_fit(f, drive) for f in fits] + [_row_of_car("multibody car", car, FITTED_NUMBERS, drive)]
    tables = {
        "models": rows,
        "parts": [_row_of_car(name, compare_car(values, brief=True), 0, drive) for name, values in PARTS_LEFT_OUT],
        "published": published_rows(*full_throttle(options.car, {"step_size": STEP})),
        "curves": _curves(car, drive),
        "notes": [{"note": note} for note in car.notes],
    }
    if options.picture is not None:
        chosen = fits[CHART_MODEL]
        draw(drive, car.time, car.path, chosen.path, chosen.model.name, options.picture)
    return [{"table": name, **row} for name, table_rows in tables.items() for row in table_rows]


def _kinds(options: Namespace) -> list[dict[str, Any]]:
    log, aliases = _log(options)
    models = [*(m for m in MODELS if m.name in LEFT_OUT), two_track.MODEL]
    car = omitted_seconds.CarTask(options.car, log, aliases, {"step_size": COARSE}, options.bounds or BOUNDS)
    return omitted_seconds.rows_of(models, BODY, read_drive(log, aliases), car)


def _log(options: Namespace) -> tuple[Path, Path]:
    """The log and its alias file."""
    if options.log is None:
        raise UserError("The log of the drive is given by --log FILE.")
    return options.log, options.aliases or ALIASES


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


def _curves(car: DriveComparison, drive: Drive) -> list[dict[str, Any]]:
    """Rows of understeer angle and sideslip by lateral acceleration: measured mean, and difference of the car."""
    return [
        {
            "quantity": c.quantity,
            "ay, g": c.acceleration,
            "seconds": c.seconds,
            "measured": c.measured,
            "spread": c.spread,
            "multibody car": c.difference,
        }
        for c in curves(drive, BODY.wheelbase, *car.predicted)
        if c.seconds >= ENOUGH
    ]


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


def blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Tables of the page by the names of their marks."""
    rows_of = {
        name: [{k: v for k, v in r.items() if k != "table"} for r in rows if r["table"] == name] for name in COLUMNS
    }
    tables = {name: table(rows_of[name], COLUMNS[name]) for name in ("models", "parts", "published", "curves")}
    notes = "\n".join(f"- {row['note']}" for row in rows_of["notes"])
    return tables | {"notes": notes}


LOGGED: dict[str, tuple[Any, str]] = {
    "log": (Path, "CSV, perhaps packed (.csv.gz)"),
    "car": ("ferrari_250_lm", "FMU or car"),
    "aliases": (Path, "aliases of the log, for the car; by default the Ferrari's"),
}
FITTED_PARAMETERS: dict[str, tuple[Any, str]] = {
    "bounds": (Path, "sought parameters and their bounds; by default the Ferrari's"),
}
PARTS = {
    "drive": Part(
        "simple models and the multibody car through a measured drive",
        _drive,
        options=LOGGED | {"picture": (Path, "draw measured and predicted yaw rate (PNG)")},
        pages=(PAGE,),
        blocks=blocks,
    ),
    "fit": Part(
        "fit the multibody car to the drive",
        lambda options: refit(options.car, *_log(options), options.bounds or BOUNDS),
        options=LOGGED | FITTED_PARAMETERS,
        words=lambda rows: table(rows, FIT_COLUMNS),
        check=lambda rows, options: problems(rows),
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
