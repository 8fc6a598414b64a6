"""Writes the report of standard tests as an HTML file."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from ali3.files import write_text
from hosts.catalogue.car import TestedCar
from hosts.catalogue.report.overview import car_tables, overview_tables
from hosts.catalogue.report.pictures import drawings_of
from hosts.catalogue.report.section import make_section
from hosts.catalogue.standard_test import StandardTest, TestRecord
from hosts.experiment.report import Plots, Section, page

_NOTHING: Mapping[str, Mapping[str, float]] = {}


def write_report(
    file: Path,
    tests: Sequence[StandardTest],
    cars: Sequence[TestedCar],
    records: Mapping[str, Mapping[str, TestRecord | str]],
    settings: Mapping[str, Mapping[str, float]] = _NOTHING,
    command: Sequence[str] = (),
) -> None:
    """Write the report as one self-contained HTML file, and each plot as SVG into the folder ``plots`` beside it.

    Parameters
    ----------
    file : Path
        Written whole or not at all.
    tests : sequence of StandardTest
        In the order of the report.
    cars : sequence of TestedCar
        One or more, of different labels; the others are compared with the first.
    records : mapping of str to mapping of str to TestRecord or str
        By name of the test and label of the car; a str is the reason why a test could not be done.
    settings : mapping of str to mapping of str to float
        Settings other than the defaults, by name of the test.
    command : sequence of str
        Command of the report, such as ``["ali3", "catalogue", "car.fmu"]``.

    Raises
    ------
    ali3.errors.FileError
        The file cannot be written.
    """
    labels = [car.label for car in cars]
    plots = Plots(file.parent / "plots")
    sections = [Section("Overview", overview_tables(tests, labels, records), "overview")]
    for test in tests:
        results = {n: r for n in labels if (r := records.get(test.name, {}).get(n)) is not None}
        pictures = drawings_of({n: r.plots for n, r in results.items() if isinstance(r, TestRecord)})
        plot_elements = [plots.add(drawing, f"{test.name} {name}") for name, drawing in pictures.items()]
        sections.append(make_section(test, results, settings.get(test.name, {}), command, plot_elements))
    write_text(file, page(f"Standard tests of {', '.join(labels)}", car_tables(cars), sections))
