"""What must be read to know a command: lines of all files that it imports, also inside functions.

python -m tests.house.reading
"""

from __future__ import annotations

from collections.abc import Collection, Iterable

import grimp

from ali3.commands import COMMANDS
from tests.house.test_circles import FACADES, PACKAGES, ROOT

CAR = {"CAR": "hosts.fmu.built_fmu"}
RECORDING = {"--manoeuvre RECORDING": "hosts.recordings.last_drive"}
PARAMETERS = {"--parameters": "hosts.fmu.parameter_file_settings"}
TABLES = {
    "--manoeuvre FILE.csv": "hosts.driving.manoeuvre_table",
    "--manoeuvre FILE.ini": "hosts.driving.old_manoeuvre",
}
STATE = {"[state]": "hosts.driving.state_file"}
DRIVER = {"a manoeuvre's driver": "hosts.driving.driver"}
NEW_ROAD = {"--road": "hosts.common.road"}
ALIASES = {"--aliases": "hosts.fmu.aliases.file", "from = FORMULA": "hosts.fmu.aliases.formulas"}
EVERY = {"a package is missing": "ali3.extras"}
CLONE = {"the page of a clone": "viewer.page_build"}
TYPED = {"a fault in a file": "ali3.typed_sentences"}
WAYS = {
    "build": {**EVERY, "--kernel": "mbs.kernel.build"},
    "car": {
        **EVERY,
        **TYPED,
        "FOLDER": "mbs.vehicle.copy_car",
        "--kinematics": "mbs.vehicle.kinematics.report",
        "--cheapest": "mbs.vehicle.levels.report",
        "schema = 1": "mbs.vehicle.older_files",
        "[ports]": "mbs.vehicle.port_parts",
        "[ports] of a driver": "mbs.vehicle.port_inputs",
        "[ports] tyre": "mbs.vehicle.hub_port",
        "drive.kind electric": "mbs.vehicle.drives.electric",
        "suspension.kind macpherson": "mbs.vehicle.suspensions.macpherson",
        "suspension.kind twist_beam": "mbs.vehicle.suspensions.twist_beam",
        "suspension.kind curves": "mbs.vehicle.suspensions.curves",
        "steering.rack_by_wheel_angle": "mbs.vehicle.steering.rack_table",
        "a driven rack": "mbs.vehicle.steering.driven_rack",
        "what a steering reports": "mbs.vehicle.steering.steering_outputs",
        "steering.kind column": "mbs.vehicle.steering.column",
        "steering.kind pitman_arm": "mbs.vehicle.steering.pitman_arm",
        "tyre.kind magic_formula": "mbs.vehicle.tyres.magic_formula",
        "a flexible frame": "mbs.vehicle.chassis.flexible_chassis",
        "modes of a flexible frame": "mbs.vehicle.chassis.flexible_frame",
        "frame.kind tubes": "mbs.vehicle.chassis.frames.tubes",
        "frame.kind nastran": "mbs.vehicle.chassis.frames.nastran",
        "frame.kind calculix": "mbs.vehicle.chassis.frames.calculix",
        "frame.kind matrices": "mbs.vehicle.chassis.frames.matrices",
        "a mesh": "viewer.mesh_file",
        "a road under it": "mbs.vehicle.steep_road",
        "fidelity by tables": "mbs.vehicle.tabled_axle",
        "a drawing": "mbs.vehicle.shapes.car_shapes",
        "what a drawing follows": "mbs.vehicle.outputs",
        "words of a model that is drawn": "mbs.model.model",
        "stresses that are drawn": "mbs.vehicle.chassis.stress_scene",
        "an axle without stops": "mbs.vehicle.linkages.free_travel",
    },
    "run": {
        **EVERY,
        **CAR,
        **RECORDING,
        **PARAMETERS,
        **TABLES,
        **DRIVER,
        **STATE,
        **NEW_ROAD,
        "--manoeuvre": "hosts.recordings.load_manoeuvre",
        "the page of a car": "hosts.run.car_page",
        "the driver's course": "hosts.run.course_result",
        "--kerb": "hosts.run.kerb",
        "--aliases": "hosts.run.other_names",
    },
    "view": {**EVERY, "RESULT": "hosts.view.show", "--live": "hosts.view.live", **PARAMETERS},
    "simulator": {
        **EVERY,
        **CLONE,
        **CAR,
        **RECORDING,
        **ALIASES,
        **PARAMETERS,
        "--record": "hosts.recordings.recording",
        "columns of --record": "hosts.recordings.recorded_columns",
        "--recording": "hosts.recordings.show",
        "--headless": "hosts.simulator.headless",
        "wheels and gamepads": "hosts.simulator.devices",
    },
    "check": {
        **EVERY,
        **CAR,
        **RECORDING,
        **PARAMETERS,
        **TABLES,
        **STATE,
        "--show-parameters": "hosts.check.parameters",
        "--reference": "hosts.check.reference",
        "--soak": "hosts.soak.soak",
    },
    "catalogue": {**EVERY, **CAR, **ALIASES},
    "compare": {**EVERY, **CAR, **ALIASES, "--fit": "hosts.compare.fitting"},
    "study": {
        **EVERY,
        **CAR,
        **RECORDING,
        **ALIASES,
        **TABLES,
        **DRIVER,
        **STATE,
        **TYPED,
        "manoeuvre = NAME": "hosts.study.named_manoeuvre",
        "rows that are there": "hosts.study.earlier_start",
        "aliases = FILE": "hosts.study.other_names",
        "what aliases are": "hosts.fmu.aliases.alias",
        "variables under other names": "hosts.fmu.aliased_fmu",
        "columns of other names": "hosts.driving.derived_columns",
        "[limits]": "hosts.measures.limits",
        "whether [limits] hold": "hosts.study.limits",
        "[measures]": "hosts.study.measures.parse",
        "what measures are": "hosts.study.measures.study_measure",
        "[signals]": "hosts.study.signals",
        "method = table": "hosts.study.table_points",
        "method = sobol": "hosts.study.drawn_points",
        "other units": "hosts.common.units",
        "units of reports": "hosts.common.display_units",
        "--scheduler": "hosts.study.scheduler",
        "test = NAME": "hosts.study.catalogue_tests",
        "--target": "hosts.study.target",
        "FILE.py:FUNCTION": "hosts.study.measures.user_function",
        "--run": "hosts.study.repeat",
        "--report": "hosts.study.analysis.report",
    },
    "road": {**EVERY, "INPUT": "mbs.worlds.road", "--world": "mbs.worlds.world"},
}
"""What commands do besides, or instead, where an option, a file or a fault asks for it: the module of it."""


def lines_of(module: str) -> int:
    """Lines of a module's file."""
    path = ROOT.joinpath(*module.split("."))
    file = path.with_suffix(".py")
    return len((file if file.is_file() else path / "__init__.py").read_text(encoding="utf-8").splitlines())


def read_for(graph: grimp.ImportGraph, module: str, besides: Iterable[str] = ()) -> set[str]:
    """A module, all that it imports, and the packages around them, without what others do besides."""
    found = set(besides)
    todo = [module]
    while todo:
        name = todo.pop()
        if name in found or name in FACADES:
            continue
        found.add(name)
        todo += [*graph.find_modules_directly_imported_by(name), *filter(None, [name.rpartition(".")[0]])]
    return found - set(besides)


def main() -> None:
    """Print the table."""
    graph = grimp.build_graph(*PACKAGES, exclude_type_checking_imports=False, cache_dir=None)
    for command in COMMANDS:
        ways = WAYS.get(command.name, {})
        _row(command.name, read_for(graph, command.module, ways.values()))
        for way, module in ways.items():
            _row(f"{command.name} {way}", read_for(graph, module))
        if ways:
            _row(f"{command.name}, all of it", read_for(graph, command.module))


def _row(name: str, files: Collection[str]) -> None:
    print(f"{name:31} {len(files):4d} files {sum(map(lines_of, files)):6d} lines")


if __name__ == "__main__":
    main()
