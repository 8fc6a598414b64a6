"""Writes the report."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from ali3.files import make_folder, write_text
from ali3.html_elements import document, element
from hosts.catalogue.car import TestedCar
from hosts.catalogue.record import StandardTest, TestRecord
from hosts.catalogue.report.overview import head, overview
from hosts.catalogue.report.pictures import pictures_of
from hosts.catalogue.report.section import section

_NOTHING: Mapping[str, Mapping[str, float]] = {}


def write_report(
    file: Path,
    tests: Sequence[StandardTest],
    cars: Sequence[TestedCar],
    records: Mapping[str, Mapping[str, TestRecord | str]],
    settings: Mapping[str, Mapping[str, float]] = _NOTHING,
    command: Sequence[str] = (),
) -> None:
    """Write one HTML file that needs no other, each plot as an SVG file of the folder ``plots`` beside it.

    Parameters
    ----------
    file : Path
        It is there whole or not at all.
    tests : sequence of StandardTest
        In the order of the report.
    cars : sequence of TestedCar
        One or more, of different labels; the first is what the others are held against.
    records : mapping of str to mapping of str to TestRecord or str
        By name of the test and label of the car; a str is the reason why a test could not be done.
    settings : mapping of str to mapping of str to float
        By name of the test; what is missing is by default.
    command : sequence of str
        That made it, such as ``["ali3", "catalogue", "car.fmu"]``.

    Raises
    ------
    ali3.errors.FileError
        The file cannot be written.
    """
    labels = [car.label for car in cars]
    title = f"Standard tests of {', '.join(labels)}"
    links = [element("li", element("a", test.title, href=f"#{test.name}")) for test in tests]
    by_car = {
        test.name: {n: r for n in labels if (r := records.get(test.name, {}).get(n)) is not None} for test in tests
    }
    drawn = {
        name: pictures_of({n: r.plots for n, r in found.items() if isinstance(r, TestRecord)})
        for name, found in by_car.items()
    }
    body = [
        element("h1", title),
        *head(cars),
        element("nav", element("ul", *links), aria_label="Tests"),
        element("h2", "Overview"),
        *overview(tests, labels, records),
        *(section(t, by_car[t.name], settings.get(t.name, {}), command, drawn[t.name]) for t in tests),
    ]
    write_text(file, document(title, body))
    folder = make_folder(file.parent / "plots")
    for name, pictures in drawn.items():
        for picture in pictures:
            stem = re.sub(r"[^A-Za-z0-9]+", "_", f"{name} {picture.title}").strip("_")[:80]
            write_text(folder / f"{stem}.svg", picture.svg.decode("utf-8"))
