"""Writes a page that runs FMUs: ``ali3 view --live``."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from threading import Timer
from typing import TYPE_CHECKING, Any

from ali3.files import check_writable, write_bytes
from ali3.temporary_folder import temporary_folder
from hosts.common.commands import run_ali3
from hosts.common.errors import HostError
from hosts.common.options import ROAD, FmuOptions
from hosts.common.package_names import check_world
from hosts.common.road import options_with_road, report_starts
from hosts.common.world_files import make_world
from hosts.driving.manoeuvre import with_names_of
from hosts.fmu.fmu_file import fmu_file
from hosts.fmu.settings import settings_of
from hosts.recordings.format import is_recording
from hosts.recordings.load_manoeuvre import check_manoeuvre_option, load_manoeuvre
from hosts.view.open_page import open_page
from hosts.view.page_parts import PLATFORM, build_command, fmu_parts, page_text, script_of
from hosts.view.view_sources import ViewRunOptions, recordings_of

if TYPE_CHECKING:
    from ali3.scene.recording import Recording
    from hosts.common.numbers import Value
    from hosts.common.world_files import World
    from hosts.driving.manoeuvre import Manoeuvre
    from hosts.fmu.variables import Variable
    from hosts.view.page_parts import FmuParts

_REPORT_DELAY = 2.0
_MOST_PICTURES = 4


def live(options: argparse.Namespace) -> int:
    """Write one HTML file that runs FMUs of this program in any browser, and open it; gives the exit code."""
    with temporary_folder() as folder:
        return _write(options, options_with_road(options, folder))


def _write(options: argparse.Namespace, set_options: FmuOptions) -> int:
    if len(options.what) > _MOST_PICTURES:
        raise HostError(f"{len(options.what)} pictures are too many for a page; it shows at most {_MOST_PICTURES}.")
    results = [path for path in options.what if path.suffix.lower() in (".csv", ".json") or is_recording(path)]
    check_manoeuvre_option(options.manoeuvre)
    if options.world is not None:
        check_world(options.world)
    paths = [fmu_file(path) for path in options.what if path not in results]
    if not paths:
        raise HostError(f"{results[0]} is a result; --live needs an FMU, which the page runs.")
    name = "_".join(dict.fromkeys(path.stem for path in paths))
    file = (options.out or Path("out")) / f"{name}_live.html"
    road = next((text for name, text in reversed(set_options.values) if name == ROAD), "")
    check_writable(file)
    world = _world(options, road)
    fmus = [fmu_parts(path, road if world is None else str(world.road)) for path in paths]
    names = _titles(fmus, options.name)
    manoeuvre = _manoeuvre(fmus, options.manoeuvre)
    page_options = {"name": name, **_page_options(fmus, options), **_starts(fmus, world, manoeuvre, set_options)}
    recordings = _recordings_beside(results, fmus[0])
    named_fmus = [(name, _with_binary(fmu)) for name, fmu in zip(names, fmus, strict=True)]
    title = options.title if options.title is not None else ", ".join(names)
    ends = [f"The recording ends at {float(recording.t[-1]):.4g} s." for recording in recordings]
    with _reported_when_long("making the page"):
        text = page_text(title, named_fmus, page_options, manoeuvre, recordings, ends)
    write_bytes(file, text.encode())
    _report(file, fmus, world)
    if not options.no_open:
        open_page(file)
    return 0


def _report(file: Path, fmus: Sequence[FmuParts], world: World | None) -> None:
    """Print what is not drawn, the size of the page and how the world was thinned."""
    for fmu in fmus:
        for item in fmu.scene.get("missing", []):
            print(f"{fmu.name}: {item['name']} is not drawn: {item['why'].rstrip('.')}.")
    print(f"{file}: {file.stat().st_size / 1e6:.1f} MB; it opens from disk in a browser and needs nothing else")
    if world is not None and world.content.get("thin"):
        print(world.content["thin"])


def _starts(
    fmus: Sequence[FmuParts], world: World | None, manoeuvre: Manoeuvre | None, set_options: FmuOptions
) -> dict[str, Any]:
    """Start values of the page, and those of the places of its world, if there are any."""
    places = {} if world is None else _places(world, fmus[0])
    first = next(iter(places.values()), {})
    start = {**first, **({} if manoeuvre is None else manoeuvre.start), **_start(fmus, set_options)}
    report_starts([start])
    if fmus[0].own_road is not None:
        start[ROAD] = fmus[0].own_road.name
    return {"start": start} | ({"places": places} if places else {})


def _world(options: argparse.Namespace, road: Value) -> World | None:
    """The world of the page, if one is asked for."""
    if options.world is None:
        return None
    if road:
        raise HostError(f"The road is given by --world {options.world} and by {road}; give it once.")
    return make_world(options.world, lambda line: print(line, flush=True), thin=True)


def _places(world: World, fmu: FmuParts) -> dict[str, dict[str, Value]]:
    """Start values of the places of a world, where the FMU has them."""
    if ROAD not in fmu.variables.names:
        raise HostError(
            f"{fmu.path} has no parameter '{ROAD}', so that the world {world.name} cannot be put under it; leave "
            "--world out."
        )
    return {name: values for name, values in world.places().items() if set(values) <= set(fmu.variables.names)}


def _manoeuvre(fmus: Sequence[FmuParts], name: str | None) -> Manoeuvre | None:
    """A manoeuvre whose columns the FMUs have; None without a name."""
    if name is None:
        return None
    names = [name for fmu in fmus for name in fmu.variables.names]
    manoeuvre = with_names_of(load_manoeuvre(name), names)
    script_of(manoeuvre)
    settable = [v.name for fmu in fmus for v in map(fmu.variables.__getitem__, fmu.variables.names) if _is_settable(v)]
    unknown = next((name for name in manoeuvre.inputs if name not in settable), None)
    if unknown is not None:
        raise HostError(
            f"The manoeuvre '{manoeuvre.name}' has a column '{unknown}', which is neither an input nor a tunable "
            "parameter of "
            f"{' or '.join(fmu.path.name for fmu in fmus)}."
        )
    return manoeuvre


def _is_settable(variable: Variable) -> bool:
    return variable.causality == "input" or variable.variability == "tunable"


def _recordings_beside(results: Sequence[Path], fmu: FmuParts) -> list[Recording]:
    """Recordings that are drawn beside the first FMU, with its drawing if they have none."""
    if not results:
        return []
    recordings, notes, _ = recordings_of(results, fmu.path, ViewRunOptions(None, None, None, FmuOptions([], [])))
    for line in notes:
        print(line)
    undrawn = next((r.name for r in recordings if r.scene is None), None)
    if undrawn is not None:
        raise HostError(f"The result {undrawn} cannot be drawn with {fmu.path.name}.")
    return recordings


def _titles(fmus: Sequence[FmuParts], titles_of_user: Sequence[str]) -> list[str]:
    """Titles of the pictures: those of the user, then names of the models, which are numbered if they are equal."""
    if len(titles_of_user) > len(fmus):
        raise HostError(f"--name is given {len(titles_of_user)} times for {len(fmus)} FMUs; give it once for each.")
    titles = [*titles_of_user, *(fmu.name for fmu in fmus[len(titles_of_user) :])]
    for k, title in enumerate(titles):
        if title in titles[:k]:
            titles[k] = f"{title} {titles[: k + 1].count(title)}"
    return titles


def _page_options(fmus: Sequence[FmuParts], options: argparse.Namespace) -> dict[str, Any]:
    """Checked options of the page: whether it runs at once, step and plots."""
    results: dict[str, Any] = {"run": not options.paused}
    if options.step is not None:
        if options.step > 1.0:
            raise HostError(f"--step is {options.step:g} s; it must be at most 1 s.")
        results["step"] = options.step
    plottable = {n for fmu in fmus for n in fmu.variables.names if fmu.variables[n].causality in ("input", "output")}
    for name in options.plot:
        if name not in plottable:
            raise HostError(f"--plot: {name!r} is not an input or output of {' or '.join(f.name for f in fmus)}.")
    if options.plot:
        results["plots"] = list(options.plot)
    return results


def _start(fmus: Sequence[FmuParts], set_options: FmuOptions) -> dict[str, Value]:
    """Start values by ``--parameters`` and ``--set``: the first FMU must have them, the others may."""
    start = settings_of(fmus[0].variables, set_options).start
    for fmu in fmus[1:]:
        for name in start:
            if name in fmu.variables.names:
                variable = fmu.variables.settable(name, "--set")
                variable.check(start[name], f"--set for {fmu.path.name}")
    return start


def _with_binary(fmu: FmuParts) -> FmuParts:
    """The FMU with a binary in WebAssembly, which is compiled from its own sources if it has none.

    Raises `HostError`: it cannot be compiled here; with the command that builds such an FMU.
    """
    if fmu.wasm is not None:
        return fmu
    with temporary_folder() as folder, _reported_when_long(f"compiling {fmu.path.name} for WebAssembly"):
        arguments = ("build", "--fmu", str(fmu.path.absolute()), "--platforms", PLATFORM, "--out", str(folder))
        try:
            run_ali3(*arguments)
            return replace(fmu, wasm=fmu_parts(Path(folder, fmu.path.name)).wasm)
        except HostError as error:
            reason = str(error).rstrip(".")
    raise HostError(
        f"{fmu.path} has no binary in WebAssembly, and none could be added ({reason}); build it with "
        f"{build_command(fmu.path)}"
    )


@contextmanager
def _reported_when_long(text: str) -> Iterator[None]:
    """A context that prints a line if its work takes longer than two seconds."""
    timer = Timer(_REPORT_DELAY, lambda: print(f"{text} ...", flush=True))
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
