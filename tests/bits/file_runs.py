"""Entries of the files of commands: measures, studies, comparisons, kinematics, roads, worlds, pages and glTF."""

import csv
import hashlib
import json
import os
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from tests.bits import doors, tables
from tests.bits.store import Entry, entry_of

Entries = Iterator[tuple[str, Entry]]
STUDY = """
fmu = "{fmu}"

[[manoeuvres]]
manoeuvre = "step_steer_given_throttle"
stop_time = 1.5

[sampling]
{sampling}

[parameters]
"front.spring.stiffness" = {{ range = [15000.0, 30000.0], log = true, unit = "N/m"{count} }}
"front.tyre.grip" = {{ {grip} }}

[measures]
peak = "max(abs(chassis.ay))"
load = "min(wheel_FL.Fz)"
mean = "mean(chassis.wz, after=1.1)"
spread = "range(chassis.roll) / 2 - 3 * final(chassis.roll)"

[signals]
names = ["chassis.ay"]
interval = 0.02
"""
SAMPLINGS = {
    "grid": ('method = "grid"', ", count = 2", "values = [0.8, 1.0]"),
    "latin_hypercube": ('method = "latin_hypercube"\nruns = 4\nseed = 3', "", "range = [0.8, 1.1]"),
    "sobol": ('method = "sobol"\nruns = 4\nseed = 1', "", "range = [0.8, 1.1]"),
    "saltelli": ('method = "saltelli"\nruns = 2\nseed = 1', "", "range = [0.8, 1.1]"),
}
ROADS = {
    "plane": 'kind = "plane"\nfriction = 0.8\ngrade_x = 0.02\ngrade_y = -0.01',
    "kerb": 'kind = "kerb"\nposition = 3.0\nstep = 0.06\nlower_height = -0.06\nupper = "before"\nfriction = 0.9',
    "rough": """kind = "rough"
start = 5.0
length = 20.0
width = 4.0
spacing = 0.2
roughness = "C"
seed = 2
friction = 1.0""",
    "split": 'kind = "split"\nstart = -5.0\nlength = 40.0\nleft = 1.0\nright = 0.2',
    "washboard": """kind = "washboard"
start = 4.0
length = 18.0
width = 6.0
wavelength = 3.6
amplitude = 0.01
friction = 1.0""",
}


def catalogue(car: str, test: str, settings: Sequence[str], fmus: Path, scratch: Path) -> Entries:
    """Measures of a standard test, which include fits."""
    file = doors.catalogue(doors.fmu_file(car, "fmi2", fmus), test, scratch, settings)
    yield f"catalogue/{car}/{test}", entry_of(tables.of_json_file(file), False)


def studies(fmus: Path, scratch: Path) -> Entries:
    """Rows of studies with all methods of sampling, in the order of their index."""
    for name, (sampling, count, grip) in SAMPLINGS.items():
        text = STUDY.format(fmu=doors.fmu_file("hatchback", "fmi2", fmus), sampling=sampling, count=count, grip=grip)
        file = scratch / f"{name}.toml"
        file.write_text(text, encoding="utf-8")
        rows = pd.read_parquet(doors.study(file, scratch / name)).reset_index().sort_values("index")
        numbers = rows.select_dtypes(["number", "bool"]).drop(columns="wall_seconds")
        yield f"study/{name}", entry_of({key: column.to_numpy() for key, column in numbers.items()}, False)


def comparison(fmus: Path, scratch: Path) -> Entries:
    """Comparison of an FMU with a log that has other parameters."""
    fmu = doors.fmu_file("hatchback", "fmi2", fmus)
    table = doors.drive(fmu, "step_steer_given_throttle", scratch / "drive", "--set", "front.spring.stiffness=27000")
    with table.open(newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    names = ("time", "steering", "throttle", "brake", "chassis.ay", "chassis.wz", "chassis.roll", "speed")
    columns = [k for k, heading in enumerate(rows[0]) if heading.partition(" ")[0] in names]
    log = scratch / "log.csv"
    with log.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([[row[k] for k in columns] for row in (rows[0], *rows[1:1502:5])])
    plain = doors.compare(fmu, log, scratch / "plain")
    yield "compare/step_steer", entry_of(tables.of_json_file(plain), False)


def kinematics(car: str, fmus: Path, scratch: Path) -> Entries:
    """Numbers and curves of both axles, which depend on iterations and eigenvectors."""
    file, curves = doors.kinematics(car, scratch, 9)
    yield f"kinematics/{car}/numbers", entry_of(tables.of_json_file(file), False)
    for curve in curves:
        yield f"kinematics/{car}/{curve.stem}", entry_of(tables.of_csv(curve), False)


def roads(fmus: Path, scratch: Path) -> Entries:
    """Bytes and drawings of road files and of the proving ground."""
    for name, text in ROADS.items():
        source = scratch / f"{name}.toml"
        source.write_text(text, encoding="utf-8")
        yield from _road(name, *doors.road(source, scratch))
    heights = scratch / "heights.csv"
    x, y = np.arange(0.0, 4.1, 0.5), np.arange(-2.0, 2.1, 0.5)
    rows = [["", *y], *([a, *(0.01 * a * a - 0.02 * b for b in y)] for a in x)]
    with heights.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows(rows)
    yield from _road("heights", *doors.road(heights, scratch))
    os.environ["ALI3_CACHE"] = str(scratch / "cache")  # a cached world would be copied
    yield from _road("proving_ground", *doors.world("proving_ground", scratch))


def _road(name: str, file: Path, drawing: Path) -> Entries:
    data = file.read_bytes()
    octets = np.frombuffer(data + bytes(-len(data) % 64), np.uint8).reshape(-1, 64)
    digest = np.frombuffer(hashlib.blake2b(data, digest_size=16).digest(), np.uint8)
    yield f"road/{name}/file", entry_of({"digest": digest, "blocks of octets": octets @ np.arange(1.0, 65.0)})
    yield f"road/{name}/drawing", entry_of(tables.of_json_file(drawing))


def pages(car: str, fmus: Path, scratch: Path) -> Entries:
    """The scene of an FMU, and the page and the glTF of a result."""
    for kind in doors.KINDS:
        with zipfile.ZipFile(doors.fmu_file(car, kind, fmus)) as archive:
            results = [n for n in archive.namelist() if n.endswith("geometry.json")]
            for path in results:
                signals = tables.of_json(json.loads(archive.read(path)))
                yield f"page/{car}/geometry of {kind}", entry_of(signals)
    fmu = doors.fmu_file(car, "fmi2", fmus)
    table = doors.drive(fmu, "kerb_drop", scratch / "drive", "--fidelity", 3)
    page, gltf = doors.page(table, fmu, scratch)
    yield f"page/{car}/page", entry_of(tables.of_page(page))
    yield f"page/{car}/gltf", entry_of(tables.of_gltf(gltf))
