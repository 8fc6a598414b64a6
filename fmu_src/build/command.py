"""Builds the FMUs of a car or a scene: ``ali3 build [CAR | --scene SCENE] [--kind LIST]``; or the kernel."""

from __future__ import annotations

import argparse
import importlib.util
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.command_run import run_command
from ali3.errors import UserError
from ali3.extras import missing_package
from ali3.near_names import did_you_mean
from ali3.options import Parser, add_option
from ali3.warning_lines import warning_lines

if TYPE_CHECKING:
    from ali3.parameter_set import ParameterSet
    from fmu_src.build.progress_line import ProgressLine
    from fmu_src.variables.renamed_variables import Renamed
    from mbs import System

_KINDS = "native,fmi3,python"


def main(arguments: Sequence[str] | None = None, prog: str = "python build_fmu.py") -> int:
    """Run the command; `prog` is how the user typed it."""
    parser = _parser(prog)
    options = parser.parse_args(arguments)
    if options.ports is not None and options.car is None:
        parser.error("--ports needs a car, as in ali3 build prototype")
    if options.fidelity is not None and options.car is None:
        parser.error("--fidelity needs a car, as in ali3 build prototype")
    if options.plain and (options.kernel or options.fmu is not None):
        reason = "the kernel has no code of a model" if options.kernel else "--fmu compiles the C in the FMU"
        parser.error(f"--plain needs a car or a scene to build; {reason}")
    if options.kernel:
        return run_command(lambda: _build_kernel(options.platforms, options.out), (RuntimeError,))
    options.out = options.out or Path("dist")
    if options.fmu is not None:
        return run_command(lambda: _add_platforms(options), (RuntimeError,), options)
    return run_command(lambda: _build(options), (ValueError, RuntimeError), options)


def _parser(prog: str) -> argparse.ArgumentParser:
    parser = Parser(prog=prog, description="Build the FMUs of a car or a scene, or the C kernel.")
    _add_targets(parser)
    add_option(parser, "--out", "dist; of the kernel: its place in the package")
    _add_kinds(parser)
    _add_variables(parser)
    parser.add_argument(
        "--plain",
        action="store_true",
        help="without generated C code for the algebra of the model: the same bits, slower steps, a faster build, a "
        "smaller file",
    )
    add_option(parser, "--fidelity", "the FMU of a car offers all; with N it has this one alone")
    parser.add_argument("--author", default="", help="of the model, for its description; default: the solver's authors")
    parser.add_argument("--copyright", default="", help="of the model; default: the solver's")
    parser.add_argument("--license", default="", help="of the model; default: the solver's")
    return parser


def _add_targets(parser: argparse.ArgumentParser) -> None:
    """Add what is built."""
    target_group = parser.add_mutually_exclusive_group()
    target_group.add_argument(
        "car",
        nargs="?",
        default=argparse.SUPPRESS,  # else its absence takes away what --car gave
        metavar="CAR",
        help="a car of the package by its name, a folder with a file car.toml, or such a file",
    )
    target_group.add_argument("--car", help=argparse.SUPPRESS)
    target_group.add_argument(
        "--scene",
        default="prototype_car",
        metavar="NAME",
        help="a scene of mbs.scenes, or path/to/file.py:function (a function that returns an mbs.Model or mbs.System); "
        "default: prototype_car",
    )
    target_group.add_argument(
        "--fmu",
        type=Path,
        metavar="FMU",
        help="an FMU of the kind native: its own sources are compiled for the --platforms, existing binaries stay",
    )
    target_group.add_argument("--kernel", action="store_true", help="the C kernel in place of an FMU, in a clone")


def _add_kinds(parser: argparse.ArgumentParser) -> None:
    """Add kinds of FMUs and platforms."""
    parser.add_argument(
        "--kind",
        default=_KINDS,
        metavar="LIST",
        help="native (FMI 2.0 in C), fmi3 (FMI 3.0 in C), python (FMI 2.0, runs in the host's Python); default: these; "
        "fmi3_scalar: FMI 3.0 without arrays, for hosts that read them as zeros",
    )
    parser.add_argument(
        "--platforms",
        default="this",
        metavar="LIST",
        help="out of linux64, win64, darwin64, aarch64-linux and wasm32 (WebAssembly, of the kind native); this: that "
        "of this machine, the default; all: all but wasm32 that the kind can have, that of this machine first",
    )


def _add_variables(parser: argparse.ArgumentParser) -> None:
    """Add what changes the variables of an FMU."""
    parser.add_argument(
        "--poses",
        choices=("wheels", "all"),
        help="poses as outputs for drawing, after all others: wheels (those of a car's wheels, always present) or "
        "all (of every body, and amplitudes of flexible parts); default: the amplitudes, and all poses if the "
        "drawing needs them",
    )
    parser.add_argument(
        "--ports",
        metavar="LIST",
        help="inputs of a CAR that replace parts of it by other programs, such as torque,brakes=pressure: torque "
        "(=half_shafts or =hub_motors), brakes (=torque or =pressure), steering (=rack_position or =rack_force), "
        "road, forces (=earth or =vehicle), wind, tyre, gear, clutch, and outputs (no inputs)",
    )
    parser.add_argument(
        "--names",
        metavar="NAMES",
        help="names and units of variables as in another program: carmaker, carsim, chrono, osi, "
        "vehicle_interfaces, or an alias file",
    )


def _build_kernel(platforms: str, out: Path | None) -> int:
    """The kernel for this machine, in its place; or libraries in a folder, of several platforms in one for each."""
    from mbs.kernel.build import compile_library, library_name

    if out is None and platforms == "this":
        print(compile_library())
        return 0
    from fmu_src.native.platforms import TARGETS, this_platform

    if out is None:
        raise UserError("The package has the kernel of this machine only; --out names a folder for others.")
    for platform in _platforms(platforms, this_platform()):
        for target in TARGETS[platform]:
            print(compile_library(target, out / target / library_name(target)), flush=True)
    return 0


def _add_platforms(options: argparse.Namespace) -> int:
    """Add platforms to an existing FMU."""
    from ali3.files import check_writable
    from fmu_src.build.progress_line import ProgressLine
    from fmu_src.native.added_platforms import add_platforms
    from fmu_src.native.platforms import this_platform

    _need("ziglang")
    platforms = _platforms(options.platforms, this_platform())
    file = options.out / options.fmu.name
    check_writable(file)
    line = ProgressLine()
    line.expect(len(platforms))
    added = add_platforms(options.fmu, platforms, file, line.report_stage)
    print(f"{file}: {file.stat().st_size / 1e6:.1f} MB; added: {', '.join(added) or 'nothing'}", flush=True)
    return 0


def _build(options: argparse.Namespace) -> int:
    from fmu_src.build.build import KINDS, face_name
    from fmu_src.native.early_compilation import compiled_ahead
    from fmu_src.native.platforms import TARGETS, this_platform

    kinds = list(dict.fromkeys(options.kind.split(",")))
    if set(kinds) - set(KINDS):
        raise UserError(f"There is no FMU kind '{options.kind}'; the kinds are {', '.join(KINDS)}.")
    host_platform = this_platform()
    platforms = _platforms(options.platforms, host_platform)
    if "python" in kinds:
        _need("pythonfmu")
    _need("ziglang")
    _need("pyssp_standard")

    host_platforms, other_platforms = (
        [p for p in platforms if p == host_platform],
        [p for p in TARGETS if p in platforms and p != host_platform],
    )
    libraries = [(face_name(kind), p) for p in host_platforms + other_platforms for kind in kinds if _able(kind, p)]
    with compiled_ahead(libraries), warning_lines():
        return _build_kinds(options, kinds, host_platforms, other_platforms)


def _build_kinds(options: argparse.Namespace, kinds: Sequence[str], first: Sequence[str], rest: Sequence[str]) -> int:
    """Build what this machine runs, then the same for the others."""
    from ali3.alias_file import alias_file, read_content
    from ali3.files import check_writable
    from fmu_src.build.build import FmuBuilder, fmu_name
    from fmu_src.build.progress_line import ProgressLine
    from fmu_src.native.platforms import TARGETS, able_platforms

    line = ProgressLine()
    names = None if options.names is None else read_content(alias_file(options.names))
    name, systems, fidelity, description, origin = _compiled(options, line)
    if options.names is not None:
        name = f"{name}_{Path(options.names).stem}"
    files = {kind: options.out / f"{fmu_name(name, kind)}.fmu" for kind in kinds}
    parameter_file = options.out / f"{fmu_name(name)}.ssv"
    for file in (*files.values(), parameter_file):
        check_writable(file)
    rights = (options.author, options.copyright, options.license)
    builder = FmuBuilder(systems, name, fidelity, rights, line.report_stage, description, origin, names, options.plain)
    _report_names(builder.renamed)
    platforms = [p for p in TARGETS if p in first or p in rest]
    available = {kind: [p for p in platforms if _able(kind, p)] for kind in kinds}
    for kind in [k for k in kinds if not available[k]]:
        print(f"{kind}: left out, it runs on {', '.join(able_platforms(kind))} only", flush=True)
        del available[kind]
    # what this machine runs is there after seconds; the other platforms, Windows with its C runtime, may take minutes
    first_builds = {kind: list(first) for kind in available if first and set(first) <= set(available[kind])}
    full_builds = {kind: targets for kind, targets in available.items() if first_builds.get(kind) != targets}
    meta = systems[fidelity].meta
    stages = [builds for builds in (first_builds, full_builds) if builds]
    for builds in stages:
        line.expect(builder.pieces(builds))
        for kind, targets in builds.items():
            file = builder.build(kind, targets, files[kind])
            print(
                f"{file}: {file.stat().st_size / 1e6:.1f} MB, {len(meta['inputs'])} inputs, "
                f"{len(meta['sensors'])} sensors; for {', '.join(targets)}",
                flush=True,
            )
        if builds is stages[0]:
            _write_parameters(builder.parameters, parameter_file)
        if builds is not stages[-1]:
            print(f"These run on this machine. Now the same files with {', '.join(rest)} in them:", flush=True)
    return 0


def _compiled(
    options: argparse.Namespace, line: ProgressLine
) -> tuple[str, Mapping[int, System], int, str, Mapping[str, bytes]]:
    """Name, Systems by fidelity, default fidelity, description and files of the car or the scene."""
    tables: list[str] = []
    if options.car is not None:
        from fmu_src.build.car_registry import build_car, car_text

        print(f"car {car_text(options.car)} ...", flush=True)
        with line.report_stage("compiling the car"):
            car = build_car(options.car, options.poses, options.ports, options.fidelity, tables.append)
        _report_tables(tables)
        _report_grip(car.grip)
        return car.name, car.systems, min(car.systems), car.description, car.files
    from fmu_src.build.car_registry import grip_of
    from fmu_src.build.scene_registry import car_of_scene, load_fidelities

    print(f"scene {options.scene} ...", flush=True)
    with line.report_stage("compiling the scene"):
        compiled = load_fidelities(options.scene, options.poses, tables.append)
    _report_tables(tables)
    if (scene_car := car_of_scene(options.scene)) is not None:
        _report_grip(grip_of(scene_car))
    return (*compiled, "", {})


def _report_tables(tables: Sequence[str]) -> None:
    print("".join(f"{table}\n" for table in tables), end="", flush=True)


def _report_names(renamed: Renamed) -> None:
    named = renamed.named.values()
    if not named:
        return
    other_units = {v.unit for v in named if v.scale != 1.0}
    units = f", in {', '.join(sorted(other_units))} where they have another unit" if other_units else ""
    print(f"{len(named)} of {len(renamed.table)} variables have other names{units}; the rest keep theirs", flush=True)
    reasons: dict[str, list[str]] = {}
    for name, reason in renamed.left_out.items():
        reasons.setdefault(reason, []).append(name)
    for reason, names in reasons.items():
        print(f"{', '.join(names)}: no other name; {reason}", flush=True)


def _report_grip(grip: Mapping[str, str]) -> None:
    for axle, text in grip.items():
        print(f"{axle}: {text}", flush=True)


def _write_parameters(parameters: ParameterSet, file: Path) -> None:
    """Write the set of all parameters, unless there is one that a person has edited."""
    from fmu_src.variables.parameter_file import write_beside

    if write_beside(parameters, file):
        print(f"{file}: {len(parameters.entries)} parameters, to be edited and set by --parameters", flush=True)
    else:
        print(f"{file}: differs from what a build writes, and is not overwritten", flush=True)


def _able(kind: str, platform: str) -> bool:
    from fmu_src.native.platforms import able_platforms

    return platform in able_platforms(kind)


def _platforms(text: str, here: str | None) -> list[str]:
    from fmu_src.native.platforms import PLATFORMS, TARGETS

    requested = text.split(",")
    if "this" in requested and here is None:
        raise UserError(f"No FMU runs on this machine; --platforms all builds for {', '.join(PLATFORMS)}.")
    groups = {"this": (here or "",), "all": PLATFORMS}
    names = list(dict.fromkeys(platform for word in requested for platform in groups.get(word, (word,))))
    if set(names) - set(TARGETS):
        hint = did_you_mean(text, [*TARGETS, "this", "all"], f"the platforms are {', '.join(TARGETS)}, this and all")
        raise UserError(f"Platform '{text}' is not known{hint}")
    return names


def _need(package: str) -> None:
    if importlib.util.find_spec(package) is None:
        advice = ", or leave out --kind python" if package == "pythonfmu" else ""
        raise UserError(missing_package(package) + advice)
