"""Compare figures of the pages with new ones: ``python -m benchmarks.figures [--only TEXT] [--write] [--variables]``.

Counts and errors of some tables are computed again, in a minute or two; times are not compared. Each difference is
reported with the page, the table, the row and both figures, and the exit code is 1. Charts that are drawn in seconds
are drawn again, and their descriptions compared: titles, axes, curves, summaries. The other commands write their tables
themselves; this one writes these charts, and tables that no other command makes.
"""

import argparse
import json
import sys
from collections.abc import Callable, Sequence
from functools import partial
from typing import TypeAlias

import mbs
from ali3.command_run import run_command
from ali3.files import write_text
from benchmarks.car import (
    accuracy,
    edge_answers,
    error_limits,
    fidelity,
    frame_tables,
    road_faces,
    table_cars,
    variable_tables,
)
from benchmarks.car.error_limits import trust_sentences
from benchmarks.car.frame_stiffness import stiffness
from benchmarks.car.measures import measure, measure_rows, measure_table
from benchmarks.methods import honesty, stability, stability_margins, unreduced_models
from benchmarks.paper import assembly_defect, double_four_bar, flexible_tables, puma
from benchmarks.pictures.chart_commands import charts
from benchmarks.shared.coarse_runs import expected_errors
from benchmarks.shared.command import watched
from benchmarks.shared.figures import RemadeTable, all_differences, between, read, rows_of, written
from benchmarks.shared.pages import DOCS, table
from benchmarks.validation import published_tests, tyre_rig
from fmu_src.variables.variables import variable_table
from mbs.scenes import double_four_bar as four_bar_scene
from mbs.scenes import prototype_car
from mbs.scenes import puma as puma_scene
from mbs.vehicle import load
from mbs.vehicle.kinematics.car_kinematics import kinematics
from mbs.vehicle.kinematics.table import TITLED, rows

SPEED = "docs/speed.md"
PAPER = "docs/speed_and_accuracy.md"
STABILITY = "docs/stability.md"
PAGES_OF_KEYS = {"": "all pages", "driven": "simulator, live page", "recorded": "recordings", "simulator": "simulator"}
"""Where a key acts, by the word of `viewer/keys.json`."""

Tables: TypeAlias = list[RemadeTable]
Maker: TypeAlias = Callable[..., Tables]
WRITTEN: dict[str, Maker] = {}
"""Charts, and tables that no other command writes, by name: functions of whether to make them whole."""
COMPARED: dict[str, Maker] = {}
"""Tables and sentences that other commands write, by name."""


def _named(name: str, makers: dict[str, Maker] = COMPARED) -> Callable[[Maker], Maker]:
    """Decorator: register a function by the name of its tables."""

    def register(make: Maker) -> Maker:
        makers[name] = make
        return make

    return register


@_named("Table 1")
def four_bar_table() -> Tables:
    """Energy, iterations and position errors of the double four-bar with four steps: the paper's Table 1."""
    system = mbs.compile(four_bar_scene.build(2))
    rows = [double_four_bar.measure(system, 2, "ALi3-P", h) for h in (0.05, 0.03, 0.01, 0.005)]
    return [RemadeTable(PAPER, double_four_bar.four_bar_blocks(rows)["table 1"], "table 1", ("h s",), ("ours ms",))]


@_named("Table 2")
def puma_table() -> Tables:
    """Errors of the PUMA with the default and the two most accurate methods: the paper's Table 2."""
    system = mbs.compile(puma_scene.build())
    runs = [(method, h) for method in ("ali3p", "energy_momentum_4", "radau_5") for h in (0.1, 0.05, 0.01)]
    text = puma.puma_blocks([puma.measure(system, method, h) for method, h in runs])["table 2"]
    return [RemadeTable(PAPER, text, "table 2", ("method", "h s"), ("jump open J", "jump close J"))]


@_named("stability")
def stability_margin_table() -> Tables:
    """Margins of two methods in the stability maps of the double four-bar."""
    eps: list[float | None] = [None, *map(float, stability.EPS)]
    steps = stability.steps_of("double_four_bar", 10.0 / 0.0009)
    points = [(m, h, e) for m in ("ali3p", "energy_momentum") for h in steps for e in eps]
    rows = [stability.kernel_point("double_four_bar", *point) for point in points]
    text = stability_margins.margin_table(stability_margins.margins(rows))
    excluded_columns = ("smallest fine h s", "decades below", "decades above")  # they need the smaller steps too
    return [RemadeTable(STABILITY, text, "margins", ("scene", "method"), excluded_columns)]


@_named("honesty")
def crank_honesty_tables() -> Tables:
    """The crank-slider of the modelling page: verdicts at its two largest steps, whose errors depend on round-off, and
    all figures at its smallest step.
    """
    page, key, chaotic = "docs/accuracy.md", ("h s",), ("error", "estimate", "balance", "halvings per step")
    coarse = [honesty.measure("printed_crank_slider", "ali3p", h) for h in (0.002, 0.001)]
    fine = [honesty.measure("printed_crank_slider", "ali3p", 2e-5)]
    return [
        RemadeTable(page, honesty.crank_table(coarse), "honesty crank", key, chaotic),
        RemadeTable(page, honesty.crank_table(fine), "honesty crank", key),
    ]


@_named("trust")
def trust_tables() -> Tables:
    """Tables of the page on trust."""
    keys = {"frequency": ("steps in a period",), "kerb": ("speed m s",)}
    blocks = error_limits.trust_blocks(error_limits.measure())
    return [RemadeTable("docs/trust.md", blocks[f"trust {name}"], f"trust {name}", key) for name, key in keys.items()]


@_named("car")
def car_error_tables() -> Tables:
    """Errors of the kernel in three manoeuvres of the prototype."""
    names = "step_steer_given_throttle", "double_lane_change_replay", "drop"
    rows = [accuracy.measure(name, 0.01, None, 1) for name in names]
    return [RemadeTable(SPEED, accuracy.car_blocks(rows)["car"], "car", ("manoeuvre", "h, ms"))]


@_named("handling")
def handling_table() -> Tables:
    """Measures of ride, handling and performance of two cars."""
    measured = {name: measure(load(name)) for name in ("hatchback", "prototype")}
    return [RemadeTable("docs/cars.md", measure_table(measure_rows(measured)), "handling", ("measure",))]


@_named("kinematics")
def kinematics_and_frames() -> Tables:
    """Suspension kinematics of the hatchback at the design position, and frames of two cars."""
    titles = ("bump steer", "roll centre height", "motion ratio of the spring", "wheel rate")
    results = {title: (front, rear) for title, front, rear, *_ in rows(kinematics(load("hatchback"), (-0.01, 0.01), 3))}
    sentences = [f"| {title} | {' | '.join(results[title])} |" for title in (*titles, TITLED["roll_wheel_rate"][1])]
    sentences.append(f"straight ahead, {results['steering ratio'][0]} for the hatchback")
    frames = [stiffness(load(name)) for name in ("hatchback", "prototype")]
    torsion = " | ".join(f"{f.torsion / 1e3:.3g}" for f in frames)
    hertz = " | ".join(", ".join(f"{x:.1f}" for x in f.frequencies) for f in frames)
    return [
        *(RemadeTable("docs/kinematics.md", sentence) for sentence in sentences),
        RemadeTable("docs/cars.md", f"| torsion, kN m/deg | {torsion} |"),
        RemadeTable("docs/cars.md", f"| first frequencies, free, with all masses, Hz | {hertz} |"),
    ]


@_named("tables")
def table_suspension_errors() -> Tables:
    """Errors of cars whose suspensions are tables, in some manoeuvres."""
    names = "step_steer_given_throttle", "double_lane_change_replay", "kerb_lock_brake"
    todo = ((car, name) for car in table_cars.CARS for name in names)
    text = table_cars.table_of([table_cars.compare(car, name, table_cars.STEP) for car, name in todo])
    return [RemadeTable("docs/cars.md", text, "tables", ("car", "manoeuvre"), ("us a step, tables, links",))]


@_named("flexible")
def flexible_car_tables() -> Tables:
    """Sizes of the prototype by fidelity, and iterations and peaks of its kerb test."""
    page = "docs/flexible_car.md"
    return [
        RemadeTable(page, flexible_tables.size_table(), "sizes", ("`fidelity`",)),
        RemadeTable(page, flexible_tables.kerb_table(), "kerb", ("",)),
    ]


@_named("roads")
def road_step_tables() -> Tables:
    """Wheel loads at steps of a road: of grids, and of contact planes from another program."""
    loads = road_faces.face_table([road_faces.measure("hatchback", height) for height in road_faces.HEIGHTS])
    answers = edge_answers.edge_table([edge_answers.measure(car, edge) for car, edge in edge_answers.EDGES])
    return [
        RemadeTable("docs/roads.md", loads, "faces", ("height, m",)),
        RemadeTable("docs/ports.md", answers, "edges", ("car", "edge, m")),
    ]


@_named("instructions")
def instruction_sentence() -> Tables:
    """The sentence on the double four-bar, from the table of instructions."""
    rows = rows_of(between(read(SPEED), "instructions"))
    step = next(row["instructions"] for row in rows if row["scene"] == "double four-bar")
    return [RemadeTable(PAPER, f"A step at 0.03 s takes {step} instructions")]


@_named("outputs")
def output_count() -> Tables:
    """Number of outputs of the rigid car's FMU, whose cost is on the page on FMUs."""
    table = variable_table(mbs.compile(prototype_car.build()).meta, pose=True, step_size=0.002)
    count = sum(v.causality == "output" for v in table)
    return [RemadeTable("docs/fmu_hosts.md", f"The rigid car has {count} outputs")]


@_named("README")
def readme_sentences() -> Tables:
    """Sentences of README.md, from the tables of the pages."""
    ratios = [1.0 / float(row["ratio"]) for row in rows_of(between(read(PAPER), "ratios")) if row["ratio"] != "–"]
    largest_ratio = float(f"{max(ratios):.2g}")
    kerb = {next(iter(row.values())): row for row in rows_of(read("docs/flexible_car.md").partition("## The kerb")[2])}
    time = kerb["time for the 15 s, s"]
    steps = {(r["scene"], r["step, ms"]): r["instructions"] for r in rows_of(between(read(SPEED), "instructions"))}
    sentences = (
        f"takes {min(ratios):.0f} to {largest_ratio:.0f} times as long as the best method",
        f"takes {time['fidelity 3']} s of processor time with 71 modes ({time['paper']} s in the paper)",
        f"and {time['fidelity 1']} s with a rigid frame",
        f"{steps['slalom', '5']} instructions a step of 5 ms",
    )
    return [RemadeTable("README.md", sentence) for sentence in sentences]


@_named("elements", WRITTEN)
def finite_element_tables(whole: bool) -> Tables:
    """Mass models and modes of the prototype's frame; if `whole`, also CalculiX beside two beam theories."""
    page, frame = "docs/finite_elements.md", frame_tables
    remade_tables = [RemadeTable(page, frame.modes_table(), "modes", ("modes",))]
    return (
        [*remade_tables, RemadeTable(page, frame.calculix_table(), "calculix", ("quantity",))]
        if whole
        else remade_tables
    )


@_named("assembly defect")
def assembly_defect_table() -> Tables:
    """Errors of the four-bar with assembly defect by bodies per bar; `benchmarks.paper` writes the whole table."""
    rows = [{"table": "bars", **assembly_defect.measure(case)} for case in assembly_defect.CASES[:3]]
    text = assembly_defect.defect_blocks(rows)["defect"]
    return [RemadeTable("docs/flexible.md", text, "defect", ("bodies per bar", "elements, modes of each"))]


@_named("flexible hatchback", WRITTEN)
def hatchback_kerb_table(whole: bool) -> Tables:
    """Peaks of the hatchback in the kerb test by fidelity, and if `whole` by step."""
    cases = flexible_tables.HATCHBACK[: None if whole else len(flexible_tables.KERB)]
    return [
        RemadeTable(
            "docs/cars.md", flexible_tables.hatchback_kerb_table(cases), "hatchback kerb", ("fidelity", "h, ms")
        )
    ]


@_named("unreduced models")
def unreduced_size_table() -> Tables:
    """Sizes of models without reduced coordinates and constraints."""
    text = unreduced_models.size_table([unreduced_models.sizes_of(scene)[0] for scene in unreduced_models.SCENES])
    return [RemadeTable("docs/flexible_car.md", text, "naive", ("scene",))]


@_named("cheapest fidelity")
def chosen_fidelity_table() -> Tables:
    """Errors of the fidelities that the page on the flexible car chooses; `benchmarks.car` writes the table."""
    page = "docs/flexible_car.md"
    return [RemadeTable(page, fidelity.choice_again(read(page)), "cheapest", ("required",))]


@_named("published tests")
def published_test_table() -> Tables:
    """Published tests: CommonRoad's Escort and the tyre on the rig; `benchmarks.validation` writes the whole table."""
    results = [*published_tests.by_commonroad(list(published_tests.CARS)[:1]), *tyre_rig.compared()]
    text = table([figure.row(value) for figure, value in results], published_tests.COLUMNS)
    return [RemadeTable("docs/validation.md", text, "others", ("test",))]


@_named("keys", WRITTEN)
def key_table(_: bool) -> Tables:
    """Keys of the pages, from the file that the pages read."""
    keys = json.loads(read("viewer/keys.json"))
    rows = [{"key": k["shown"], "what": k["words"], "where": PAGES_OF_KEYS[k.get("where", "")]} for k in keys]
    return [RemadeTable("docs/driving.md", table(rows, dict.fromkeys(rows[0], "")), "keys", ("key", "where"))]


_named("charts", WRITTEN)(charts)
_named("trust page")(trust_sentences)


@expected_errors()
def main(arguments: Sequence[str] | None = None) -> int:
    """Run ``python -m benchmarks.figures``: compute figures of the pages again, and compare or write them."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.figures", description=__doc__)
    names = ", ".join((*WRITTEN, *COMPARED))
    parser.add_argument("--only", default="", metavar="TEXT", help=f"part of a name: {names}")
    parser.add_argument("--write", action="store_true", help=f"make all of {', '.join(WRITTEN)}, and write them")
    parser.add_argument("--variables", action="store_true", help="print the tables of the cars' variables alone")
    options = parser.parse_args(arguments)
    if options.variables:
        for name, text in variable_tables.blocks(variable_tables.tables()).items():
            print(f"{name}\n\n{text}\n")
        return 0
    makers: dict[str, Maker] = {name: partial(make, options.write) for name, make in WRITTEN.items()}
    makers |= {} if options.write else COMPARED
    selected_makers = [make for name, make in makers.items() if options.only.lower() in name.lower()]
    if not selected_makers:
        parser.error(f"no table is called {options.only!r}: {names}")
    remade_tables = [remade_table for make in watched(selected_makers) for remade_table in make()]
    return _write(remade_tables) if options.write else _compare(remade_tables)


def _write(remade_tables: Tables) -> int:
    for remade_table in remade_tables:
        if remade_table.picture:
            (DOCS.parent / remade_table.page).write_bytes(remade_table.picture)
        else:
            write_text(DOCS.parent / remade_table.page, written(remade_table, read(remade_table.page)))
    print(f"{len(remade_tables)} tables and charts written")
    return 0


def _compare(remade_tables: Tables) -> int:
    sentences = all_differences(remade_tables)
    as_made = f"{len(remade_tables)} tables, sentences and charts of the pages are as they are made now."
    print("\n".join(sentences) or as_made)
    return 1 if sentences else 0


if __name__ == "__main__":
    sys.exit(run_command(main))
