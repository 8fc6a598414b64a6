"""The report: its content, valid HTML, and escaped names."""

import re
import shutil
import zipfile
from itertools import pairwise

import html5lib
import numpy as np
import pytest
from lxml import etree

from ali3.errors import FileError
from ali3.units import typeset
from hosts.catalogue.measure_sheet import mean_of_sides
from hosts.catalogue.output import print_measures
from hosts.catalogue.report import write_report
from hosts.catalogue.report.numbers import difference_text, number_text
from hosts.catalogue.report.pictures import drawings_of
from hosts.catalogue.standard_test import Line, Plot, TestRecord
from hosts.experiment.report import MOST_POINTS, thinned_indices
from hosts.measures.measure import Limit, Measure
from tests.hosts.catalogue.synthetic_records import EVIL, record, synthetic

pytestmark = pytest.mark.drawn

COMMAND = ["ali3", "catalogue", "my car.fmu", "--tests=test_0", "--test-setting", "test_1.speed=80", "--jobs", "2"]


@pytest.fixture(scope="module")
def fmu(tmp_path_factory):
    """Its description is all that a report reads of a car."""
    file = tmp_path_factory.mktemp("fmu") / "small.fmu"
    text = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="Small &lt;b&gt;" guid="{1-2}" generationTool="a tool"
numberOfEventIndicators="0"><CoSimulation modelIdentifier="small"/>
<UnitDefinitions><Unit name="N/m"><BaseUnit kg="1" s="-2"/></Unit></UnitDefinitions>
<DefaultExperiment stepSize="0.004"/>
<ModelVariables><ScalarVariable name="front.spring.stiffness" valueReference="0" causality="parameter"
variability="fixed"><Real start="12360" unit="N/m"/></ScalarVariable>
<ScalarVariable name="initial.x" valueReference="1" causality="parameter" variability="fixed"><Real start="0"/>
</ScalarVariable></ModelVariables><ModelStructure/></fmiModelDescription>"""
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("modelDescription.xml", text)
    return file


@pytest.fixture(scope="module")
def report(fmu, tmp_path_factory):
    """The file with its document as a browser reads it."""
    file = tmp_path_factory.mktemp("report") / "report.html"
    tests, cars, records = synthetic(fmu, tests=3, points=5000)
    write_report(file, tests, cars, records, {"test_0": {"speed": 80.0}}, COMMAND)
    parser = html5lib.HTMLParser(tree=html5lib.getTreeBuilder("lxml"), namespaceHTMLElements=False)
    document = parser.parse(file.read_text("utf-8"))
    assert parser.errors == []
    return file, document


def texts(elements):
    return [" ".join("".join(e.itertext()).split()) for e in elements]


def test_nothing_in_a_name_becomes_a_part_of_the_page(report):
    _, document = report
    assert EVIL in texts(document.xpath("//th"))
    assert EVIL in document.findtext(".//title")
    assert not document.xpath("//script | //b")
    assert "Small <b>" in texts(document.xpath("//td"))


def test_everything_of_a_car_is_in_the_header(report):
    _, document = report
    rows = {texts(row)[0]: texts(row)[1:] for row in document.xpath("(//table)[1]//tr")}
    assert rows["GUID"] == ["{1-2}"] * 3
    assert rows["communication step"] == ["0.004 s"] * 3
    assert rows["file"] == ["small.fmu"] * 3
    changed = {texts(row)[0]: texts(row)[1:] for row in document.xpath("(//table)[2]//tr")}
    assert changed["front.spring.stiffness"] == ["as built", "15000 N/mas built 12360 N/m", "as built"]
    assert "initial.x" not in changed


def test_limits_and_differences_are_reported_by_words(report):
    _, document = report
    row = next(r for r in document.xpath("//tr") if "yaw_rate.overshoot" in "".join(r.itertext()))
    assert texts(row)[1:] == [
        "0.12 kept",
        "0.22 not kept+0.1 (+83.3 %)",
        "0.32 not kept+0.2 (+167 %)",
        "at most 0.2a rule, 5.2",
    ]
    assert [s.get("class") for s in row.iter("span") if s.get("class")] == ["kept", "broken", "broken"]
    missing = next(r for r in document.xpath("//tr") if "roll.time" in "".join(r.itertext()))
    assert texts(missing)[0].endswith("roll.time, s The car has no output chassis.roll.")  # said once for all cars
    assert texts(missing)[1:4] == ["–", "–", "–"]


def test_limits_of_their_own_units_and_notes(fmu, tmp_path):
    """Cars may differ in what they must keep, in units, and in what they lack."""
    tests, cars, _ = synthetic(fmu, cars=3, tests=1)
    result = [
        Measure("a", 1.0, "m", "a", Limit("x", lowest=0.5), "one"),
        Measure("a", 0.4, "rad", "a", Limit("x", lowest=0.3), "two"),
    ]
    records = {"test_0": {car.label: TestRecord([m], [], {}) for car, m in zip(cars, result, strict=False)}}
    write_report(tmp_path / "r.html", tests, cars, records)
    document = html5lib.parse((tmp_path / "r.html").read_text("utf-8"), "lxml", namespaceHTMLElements=False)
    row = next(r for r in document.xpath("//tr") if texts(r)[0] == "a a, m")
    assert texts(row)[1:] == [
        "1 m keptone",
        "22.92 deg kepthere at least 17.189 degin deg; the first car in mtwo",
        "–",
        "at least 0.5 mx",
    ]
    assert "not selected" in texts(document.xpath("//td"))


def test_a_section_has_all_of_a_test(report):
    _, document = report
    text = texts(document.xpath("//section[@id='test_0']"))[0]
    for message in (
        "ISO 7401:2011, Lateral transient response test methods",
        "8.2: a step of the steering wheel in 0.1 s (text checked)",
        "at 100 km/h (from public summaries)",
        f"{EVIL}: The step was 12 ms; take 10 ms.",
        "80 km/hby default 100 km/h",
        "ali3 catalogue 'my car.fmu' --jobs 2 --tests test_0",
    ):
        assert message in text
    not_done = texts(document.xpath("//section[@id='test_1']"))[0]
    assert "with $stiff$ springs: not done. The FMU has no variable steering;" in not_done
    assert "--test-setting test_1.speed=80 --jobs 2 --tests test_1" in not_done
    assert len(document.xpath("//section[@id='test_0']//details")) == 4


def test_tables_have_headers_and_pictures_have_words(report):
    _, document = report
    for table in document.xpath("//table"):
        assert table.find("caption") is not None
        assert all(th.get("scope") for th in table.iter("th"))
    alt = document.xpath("(//section[@id='test_0']//img)[2]")[0].get("alt")
    assert alt.startswith("Gain: gain, 1/s over frequency, Hz. roll: from 1 at 0.2 to 0.05 at 4,")
    assert "as built, yaw rate: from 0.9615 at 0.2 to 0.05882 at 4," in alt
    links = {a.get("href")[1:] for a in document.xpath("//a")}
    ids = document.xpath("//@id")
    assert links <= set(ids)
    assert len(ids) == len(set(ids))


def svg_of(picture):
    return etree.fromstring(picture.svg)


def test_cars_differ_without_colour(fmu):
    """In dashes: by them alone two cars can be told apart in grey."""
    plot = Plot("p", "x, m", "y, m", [Line("", np.arange(50.0), np.arange(50.0))])
    picture = drawings_of({f"car {k}": [plot] for k in range(5)})["p"]
    paths = svg_of(picture).xpath(
        "//*[starts-with(@id, 'axes_1')]//*[local-name()='path'][contains(@style, 'stroke: #')]"
    )
    styles = [p.get("style") for p in paths]
    lines = [s for s in styles if re.search("stroke: #(0072b2|d55e00|009e73|e69f00|cc79a7)", s)]
    dashes = {(re.search("stroke-dasharray: ([^;]*)", s) or ["", "whole"])[1] for s in lines}
    assert len(lines) >= 5
    assert len(dashes) == 5


def test_plots_of_several_cars_are_one_picture():
    pictures = drawings_of({"a": record(0, 500).plots, "b": record(1, 500).plots[:2]})
    assert list(pictures) == ["Yaw rate", "Gain", "Path"]
    assert "a: from" in pictures["Yaw rate"].words
    assert "b: from" in pictures["Yaw rate"].words
    assert "b" not in re.findall(r"(?:\. |; )(\w+):", pictures["Path"].words)


def test_what_is_the_same_for_all_cars_is_drawn_once():
    x = np.arange(100.0)
    lanes = Line("lanes", x, np.where(x < 50.0, 1.0, np.nan))
    plots = {f"car {k}": [Plot("p", "x, m", "y, m", [lanes, Line("path", x, k * x)])] for k in range(3)}
    message = drawings_of(plots)["p"].words
    assert message.count("lanes") == 1
    assert all(f"car {k}, path" in message for k in range(3))
    same = {f"car {k}": [Plot("p", "x, m", "y, m", [lanes])] for k in range(2)}
    assert "car 1" in drawings_of(same)["p"].words


def test_empty_and_broken_lines_are_drawn():
    nothing = Line("nothing", np.full(5, np.nan), np.full(5, np.nan))
    plots = [Plot("p", "x, 1", "y, 1", [nothing, Line("none", np.empty(0), np.empty(0))]), Plot("q", "x", "y", [])]
    pictures = drawings_of({"a": plots})
    assert pictures["p"].words.endswith("nothing: no points; none: no points.")


def test_thinned_lines_keep_extremes_and_gaps():
    rng = np.random.default_rng(1)
    x = np.linspace(0.0, 10.0, 100_000)
    y = rng.normal(size=len(x)).cumsum()
    y[77_777] = 1e6
    y[33_333] = -1e6
    y[50_000:50_010] = np.nan
    kept = thinned_indices(x, y)
    assert len(kept) < 1.1 * MOST_POINTS
    assert {0, len(x) - 1, 77_777, 33_333} <= set(kept.tolist())
    assert np.isnan(y[kept]).any()
    assert np.array_equal(thinned_indices(x[:100], y[:100]), np.arange(100))
    # Nobody sees the difference: a step's line runs within the range of what was left out.
    for a, b in pairwise(kept):
        inside = y[a : b + 1]
        if not np.isnan(inside).any():
            reach = y[max(a - 400, 0) : b + 400]
            assert np.nanmin(reach) <= inside.min()
            assert inside.max() <= np.nanmax(reach)


def test_numbers_for_people():
    assert [number_text(v) for v in (0.123456, 1e-7, 12345.6, float("nan"), float("-inf"))] == [
        "0.1235",
        "1e-7",
        "12350",
        "–",
        "-∞",
    ]
    units = ("m/s2", "1", "N.m", "m.s-1.75", "rad.s-2", "km/h")
    assert [typeset(unit) for unit in units] == ["m/s²", "", "N·m", "m·s^-1.75", "rad·s⁻²", "km/h"]
    assert difference_text(0.9, 1.0) == "−0.1 (−10 %)"
    assert difference_text(1.0, 0.0) == "+1"
    assert difference_text(1.0, float("nan")) == ""
    assert Limit("", highest=0.35).range_text() == "at most 0.35"
    assert Limit("", 1.0, 2.0).range_text("m") == "1 to 2 m"


def test_a_car_whose_file_is_gone_and_characters_that_cannot_be_there(fmu, tmp_path):
    copy = tmp_path / "gone.fmu"
    shutil.copy(fmu, copy)
    tests, cars, records = synthetic(copy, cars=1, tests=1, points=50)
    copy.unlink()
    records["test_0"]["as built"] = "it says \x00\x1b[31m\ud800"
    write_report(tmp_path / "r.html", tests, cars, records)
    text = (tmp_path / "r.html").read_text("utf-8")
    assert "There is no file" in text
    assert "it says \ufffd\ufffd[31m\ufffd" in text


def test_the_file_is_whole_or_not_there(fmu, tmp_path):
    (tmp_path / "file").write_text("x")
    with pytest.raises(FileError, match="cannot be made"):
        write_report(tmp_path / "file" / "r.html", *synthetic(fmu, 1, 1, 50))


def test_measures_plots_and_limits_are_in_the_units_of_the_field(fmu, tmp_path, capsys):
    tests, cars, _ = synthetic(fmu, cars=1, tests=1)
    measures = [
        Measure("understeer_gradient", 2.0e-3, "rad.s2/m", "understeer gradient", Limit("x", 1.0e-3, 3.0e-3)),
        Measure("initial_speed", 25.0, "m/s", "speed", None),
        Measure("mode.natural_frequency", 2.0 * np.pi, "rad/s", "natural frequency"),
        mean_of_sides("yaw_rate.peak", 0.1, 0.2, "rad/s", "peak"),
    ]
    plot = Plot("Yaw rate", "time, s", "yaw rate, rad/s", [Line("", np.array([0.0, 1.0]), np.array([0.0, np.pi]))])
    records = {"test_0": {cars[0].label: TestRecord(measures, [plot], {})}}
    write_report(tmp_path / "r.html", tests, cars, records)
    text = (tmp_path / "r.html").read_text("utf-8")
    for message in ("1.124 deg/g", "0.56188 to 1.6856 deg/g", "90 km/h", "1 Hz", "Left 5.73, right 11.46 deg/s."):
        assert message in text
    assert "largest 180 at 1" in text  # the words of the plot
    assert not re.search(r"\brad\b", re.sub(r"base64,[^\"]*", "", text.partition("<body>")[2]))
    (svg,) = (tmp_path / "plots").glob("*.svg")
    assert svg.name == "test_0_Yaw_rate.svg"
    assert svg.read_bytes().rstrip().endswith(b"</svg>")
    print_measures(tests, cars, records)
    assert re.search(r"understeer_gradient +deg/g +1\.124\n", capsys.readouterr().out)


def test_round_off_is_no_difference():
    assert Measure("asymmetry", 5.6e-13, "1", "").displayed().value == 0.0
    assert Measure("asymmetry", 5.6e-9, "1", "").displayed().value == 5.6e-9
    assert difference_text(1.0 + 1e-13, 1.0) == "same"
    assert difference_text(3e-16, -1e-15) == "same"
    assert difference_text(1.0 + 1e-6, 1.0).startswith("+1e-6")
