"""Frames of cars, of tubes and beams: ``python -m benchmarks.frame PART``: stiffness, loads, CalculiX, pictures."""

import sys
from argparse import Namespace
from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.car import calculix, manoeuvres
from benchmarks.car.frame_pictures import draw_gauges, kerb_picture
from benchmarks.car.frame_stiffness import stiffness
from benchmarks.car.load_paths import MANOEUVRES, write_loads
from benchmarks.shared.command import Part, run
from mbs.vehicle import car_names, load

CAR = {"car": (manoeuvres.PROTOTYPE, "name, folder or file")}


def _stiffness(options: Namespace) -> list[dict[str, Any]]:
    cars = options.cars or [name for name in car_names() if load(name).chassis.frame is not None]
    rows = []
    for name in cars:
        result = stiffness(load(name))
        hertz = {f"f{k + 1}, Hz": float(f) for k, f in enumerate(result.frequencies)}
        rows.append({"car": name, "between": " and ".join(result.joints), "kN m/deg": result.torsion / 1e3, **hertz})
    return rows


PARTS = {
    "stiffness": Part(
        "torsional stiffness and lowest frequencies of free frames with all that they carry",
        _stiffness,
        options={"cars": ([], "names, folders or files; by default all of the package that have a frame")},
    ),
    "calculix": Part(
        "beams and the prototype's frame in CalculiX (ccx, Debian package calculix-ccx), stored for the tests",
        lambda options: calculix.store(),
        rows=False,
    ),
    "loads": Part(
        "loads of a car's frame, for the fidelity load_paths: the table that the key `loads` of chassis.frame names",
        lambda options: write_loads(load(options.car), options.only, options.output),
        names=MANOEUVRES,
        options=CAR | {"output": (Path, "by default the table that the car names, or loads.csv beside it")},
        rows=False,
    ),
    "gauges": Part(
        "picture of a frame with its joints and strain gauges",
        lambda options: draw_gauges(load(options.car), options.out),
        options=CAR | {"out": ("frame.png", "file")},
        rows=False,
    ),
    "stress": Part(
        "the frame in the kerb test, deformed and coloured by stress (extra `pictures`)",
        lambda options: kerb_picture(Path(options.out)),
        options={"out": ("out", "folder")},
        rows=False,
    ),
}

main = partial(run, "frame", __doc__, PARTS)

if __name__ == "__main__":
    sys.exit(main())
