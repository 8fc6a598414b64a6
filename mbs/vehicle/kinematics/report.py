"""Draws the wheel travel and steer curves of a car, and their HTML page: the work of ``ali3 car CAR --kinematics``."""

import argparse
import math
import sys
from pathlib import Path
from typing import Any

from ali3.charts import drawing
from ali3.errors import UserError
from ali3.files import check_writable, write_json, write_text
from ali3.html_elements import document, element, picture, table
from ali3.warning_lines import warning_lines
from mbs.common.progress import progress_for
from mbs.vehicle.kinematics.axle_compliance import Compliance, compliance, compliance_fidelity
from mbs.vehicle.kinematics.car_kinematics import MOTIONS, POINTS, Kinematics, checked_travel, kinematics
from mbs.vehicle.kinematics.curve_files import curve_file, write_curve
from mbs.vehicle.kinematics.curve_grid import write_curve_table
from mbs.vehicle.kinematics.plots import steer_figure, travel_figure
from mbs.vehicle.kinematics.table import compliance_rows, rows, text
from mbs.vehicle.linkages.linkage import Linkage, NotReachedError
from mbs.vehicle.read_car import load
from mbs.vehicle.suspensions.curve_table import RACK

MIN_RANGE = 1e-3  # m: a smaller range was given in m instead of mm
TRAVEL = (-80.0, 80.0)  # mm


def report(options: argparse.Namespace) -> int:
    """Print the measures at the drawing, write page and tables, and return the exit code, 1 if a curve has notes."""
    travel = TRAVEL if options.travel is None else options.travel
    low, high = checked_travel(tuple(1e-3 * v for v in travel))
    if high - low < MIN_RANGE:
        raise UserError(
            f"--travel goes from {travel[0]:g} to {travel[1]:g} mm; it is in mm and must span "
            f"{1e3 * MIN_RANGE:g} mm or more."
        )
    with warning_lines():
        car = load(options.car)
    requested = options.fidelity
    fidelity = compliance_fidelity(
        car, int(requested) if requested is not None and requested == requested // 1 else requested
    )
    folder = options.out or Path("out", "kinematics", car.name)
    names = [f"{axle}_{motion}.csv" for axle in ("front", "rear") for motion in (*MOTIONS, "table")]
    for file in (folder / "kinematics.html", *(folder / n for n in names)):
        check_writable(file)
    with progress_for(None) as bar:
        car_kinematics = kinematics(car, (low, high), POINTS if options.points is None else options.points, bar.update)
    car_compliance = compliance(car, fidelity)
    print(text([*rows(car_kinematics), *compliance_rows(car_compliance)]))
    for note in filter(None, (*car_kinematics.notes, car_compliance.sentence)):
        print(f"note: {note}", file=sys.stderr)
    for curve in car_kinematics.curves.values():
        write_curve(curve, folder / curve_file(curve))
    tables = []
    for axle in car.linked_axles:
        rack = car.steering.full if axle == "front" else 0.0
        if rack and car.steering.motion != RACK:
            kind = f"{car.steering.key('kind')} is '{car.steering.kind}'"
            print(f"note: no {axle}_table.csv, which is over the travel of a rack; {kind}.", file=sys.stderr)
            continue
        try:
            write_curve_table(Linkage(car, axle), rack, folder / f"{axle}_table.csv")
            tables.append(f"{axle}_table.csv")
        except NotReachedError as error:
            print(f"note: no {axle}_table.csv, as the links end before their stops: {error}.", file=sys.stderr)
    write_text(folder / "kinematics.html", page(car_kinematics, car_compliance))
    if options.json:
        write_json(options.json, _content(car_kinematics, car_compliance))
    print(f"\n{folder / 'kinematics.html'} and {len(car_kinematics.curves)} CSV files beside it", flush=True)
    if tables:
        print(f'{", ".join(tables)}: wheel positions, as kind = "curves" reads it', flush=True)
    return 1 if any(curve.notes for curve in car_kinematics.curves.values()) else 0


def _content(car_kinematics: Any, car_compliance: Any) -> dict[str, Any]:
    """Content of the JSON file: SI units, null for what is not a number."""
    return {
        "car": car_kinematics.car,
        "notes": list(car_kinematics.notes),
        "drawn": {axle: {n: _finite(v) for n, v in car_kinematics.drawn(axle).items()} for axle in ("front", "rear")},
        "compliance": {
            "fidelity": car_compliance.fidelity.value,
            "freedoms": car_compliance.freedoms,
            "sentence": car_compliance.sentence,
            "values": car_compliance.values,
        },
        "curves": [
            {
                "axle": curve.axle,
                "motion": curve.motion,
                "units": curve.units,
                "columns": {name: [_finite(v) for v in values.tolist()] for name, values in curve.columns.items()},
            }
            for curve in car_kinematics.curves.values()
        ],
    }


def _finite(value: float) -> float | None:
    """The value, or None if it is not finite."""
    return value if math.isfinite(value) else None


def page(kinematics: Kinematics, compliance: Compliance) -> str:
    """HTML text of the page, which needs no other file."""
    title = f"Kinematics of the car '{kinematics.car}'"
    parts = [
        element("h1", title),
        element("p", "The chassis is held, rigid; the wheel centres move. Terms of ISO 8855: x forward, y left, z up."),
        *(element("p", text) for text in (*kinematics.notes, compliance.sentence) if text),
        table(
            "",
            ("", "front", "rear", "unit", ""),
            (line if any(line[1:]) else line[:1] for line in (*rows(kinematics), *compliance_rows(compliance))),
        ),
    ]
    figures = [travel_figure(kinematics, axle) for axle, motion in kinematics.curves if motion == "parallel"]
    figures += [steer_figure(kinematics) for _, motion in kinematics.curves if motion == "steer"]
    for figure in figures:
        parts.append(picture(drawing(figure, figure.get_suptitle())))
    return document(title, parts)
