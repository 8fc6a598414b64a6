"""The driving simulator: ``ali3 simulator [FMU] [--world NAME-or-FILE] [--headless --stop-time T]``."""

from __future__ import annotations

import argparse
import importlib.util
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.command_run import GOOD, NOT_GOOD, run_command
from ali3.options import Parser, add_option, options_given
from hosts.common.errors import HostError
from hosts.common.options import add_fmu, add_setting_options, fmu_options

if TYPE_CHECKING:
    from hosts.simulator.car import Car
    from hosts.simulator.preparation import DriveRequest, Prepared
    from hosts.simulator.run_report import RunReport

_LOCAL_ADDRESS = "127.0.0.1"
_MAX_RUN_TIME = 1e6
_TITLE = "ALi3: take the wheel"
_BAR = "{desc}: {percentage:3.0f} % |{bar}| {elapsed}<{remaining}"
_RECORDING_OPTIONS = ("recording", "replay", "save_manoeuvre", "begin", "end", "fmu", "confined")


def main(arguments: Sequence[str] | None = None, prog: str = "ali3 simulator") -> int:
    """Run the command, which the user typed as `prog`; 0 unless a run without a page had a refused step."""
    begin = time.monotonic()
    parser = _parser(prog)
    options = parser.parse_args(arguments)
    return run_command(
        lambda: _simulate(options, begin) if options.recording is None else _use_recording(parser, options),
        options=options,
    )


def _use_recording(parser: argparse.ArgumentParser, options: argparse.Namespace) -> int:
    from hosts.recordings.recording_actions import replay_recording, save_manoeuvre, show_recording

    misplaced = options_given(parser, options, [name for name in vars(options) if name not in _RECORDING_OPTIONS])
    if misplaced:
        raise HostError(f"{misplaced[0]} is for driving; with --recording nothing is driven, so leave it out.")
    if options.replay and options.save_manoeuvre is not None:
        raise HostError("A recording is repeated by --replay or written by --save-manoeuvre; give one of them.")
    if options.save_manoeuvre is None and (options.begin, options.end) != (None, None):
        raise HostError("--from and --to are the part of a recording that --save-manoeuvre writes.")
    if options.save_manoeuvre is not None:
        period = (options.begin, options.end)
        return save_manoeuvre(options.recording, options.save_manoeuvre, period, options.fmu)
    return replay_recording(options.recording, options.fmu) if options.replay else show_recording(options.recording)


def _parser(prog: str) -> argparse.ArgumentParser:
    parser = Parser(
        prog=prog,
        description="Drive a car in real time: from a page in the browser, by keys, gamepad or a steering wheel.\n"
        "Ctrl-C ends with a report of the step times. With --recording: print the content of a recording,\n"
        "repeat it, or save it as a manoeuvre.",
    )
    add_fmu(parser, "?", "dist/PrototypeCar.fmu, otherwise prototype; of a recording: the one that was recorded")
    add_option(parser, "--world", "proving_ground")
    parser.add_argument("--place", metavar="NAME", help="place in the world where the car starts; default: its first")
    add_option(parser, "--step", "0.002", default=0.002)
    add_option(parser, "--fidelity", "that of the FMU")
    add_setting_options(parser)
    add_option(parser, "--aliases")
    add_option(parser, "--confined")
    parser.add_argument("--record", type=Path, metavar="DIR", help="record the drive there")
    add_option(parser, "--interval", "about 0.025 of what is drawn, 0.1 of other outputs; inputs at every step")
    add_option(parser, "--json")
    page = parser.add_argument_group("with a page")
    page.add_argument("--port", type=int, metavar="N", help="port of the server; default: the first free >= 8765")
    page.add_argument(
        "--listen",
        default=_LOCAL_ADDRESS,
        metavar="ADDRESS",
        help="address that the server listens on; default: 127.0.0.1, which only this machine reaches",
    )
    add_option(page, "--no-open")
    page.add_argument("--no-devices", action="store_true", help="do not read wheels and gamepads of this machine")
    headless = parser.add_argument_group("without a page")
    headless.add_argument("--headless", action="store_true", help="no page; the run ends by itself")
    add_option(headless, "--stop-time", "that of the manoeuvre")
    add_option(headless, "--manoeuvre")
    add_option(headless, "--seed")
    recordings = parser.add_argument_group("recordings")
    recordings.add_argument("--recording", type=Path, metavar="DIR", help="a recording: print its content")
    recordings.add_argument(
        "--replay", action="store_true", help="repeat the recording in the FMU and compare every bit"
    )
    recordings.add_argument(
        "--save-manoeuvre", type=Path, metavar="FILE.csv", help="write its last drive as a manoeuvre for ali3 run"
    )
    add_option(recordings, "--from", dest="begin")
    add_option(recordings, "--to", dest="end")
    return parser


def _simulate(options: argparse.Namespace, begin: float) -> int:
    _check_options(options)
    return _drive_headless(options, begin) if options.headless else _drive_with_pages(options, begin)


def _check_options(options: argparse.Namespace) -> None:
    """Refuse options that cannot be combined, and missing packages."""
    for package in ("fmpy",) if options.headless else ("fmpy", "websockets"):
        if importlib.util.find_spec(package) is None:
            from ali3.extras import missing_package

            raise HostError(missing_package(package))
    if options.step > 1.0:
        raise HostError(f"--step is {options.step:g} s; it must be at most 1 s.")
    recording_options = {"--replay": options.replay or None, "--save-manoeuvre": options.save_manoeuvre}
    recording_options |= {"--from": options.begin, "--to": options.end}
    if misplaced := [name for name, value in recording_options.items() if value is not None]:
        raise HostError(f"{misplaced[0]} is for a recording; --recording names its folder.")
    if options.interval is not None and options.record is None:
        raise HostError("--interval is for what --record writes; name a folder for the recording.")
    if options.interval is not None:
        from hosts.driving.run_checks import steps_of

        steps_of(options.interval, options.step, "The interval")
    headless_options = {"--stop-time": options.stop_time, "--manoeuvre": options.manoeuvre, "--seed": options.seed}
    if not options.headless and (misplaced := [name for name, value in headless_options.items() if value is not None]):
        raise HostError(
            f"{misplaced[0]} is for a run without a page; add --headless, or leave it out and end with Ctrl-C."
        )
    if options.headless and options.stop_time is None and options.manoeuvre is None:
        raise HostError("A run without a page needs its length: --headless --stop-time T, or a --manoeuvre.")
    if options.stop_time is not None and options.stop_time > _MAX_RUN_TIME:
        raise HostError(f"--stop-time is {options.stop_time:g} s; it must be at most {_MAX_RUN_TIME:g} s.")
    if options.manoeuvre is not None and options.seed is not None:
        raise HostError("Inputs are given by --manoeuvre and by --seed; give one of them.")


def _drive_request(options: argparse.Namespace) -> DriveRequest:
    from hosts.simulator.preparation import DriveRequest

    names = ("fmu", "world", "place", "fidelity", "aliases", "record")
    return DriveRequest(**{name: getattr(options, name) for name in names}, fmu_options=fmu_options(options))


def _start_car(options: argparse.Namespace, prepared: Prepared) -> Car:
    from hosts.simulator.car import Car, CarSettings

    return Car(
        CarSettings(
            prepared.fmu.path,
            prepared.settings.start,
            options.step,
            record=options.record,
            interval=options.interval,
            world=prepared.world.name or None,
            seed=options.seed,
        )
    )


@contextmanager
def _reported_end(car: Car, options: argparse.Namespace, report: RunReport) -> Iterator[None]:
    """A context at whose end the car is closed, its last events are shown and the report is written."""
    from ali3.bars import bar

    try:
        yield
    finally:
        if options.record is not None:
            report.show(f"The recording {options.record} is put together ...")
        try:
            with bar(total=1.0, desc="recording", bar_format=_BAR) as progress_bar:
                car.close(lambda fraction: progress_bar.update(fraction - progress_bar.n))
        finally:
            with suppress(HostError):  # the end of the car has been reported
                for event in car.events():
                    report.add_event(event.kind, event.text)
            report.finish(car.step_times(), options.json)


def _drive_headless(options: argparse.Namespace, begin: float) -> int:
    """Drive without a page, up to the stop time."""
    from hosts.driving.pilots.pilot import ACTS
    from hosts.recordings.load_manoeuvre import load_manoeuvre
    from hosts.simulator.aliased_car import AliasedCar
    from hosts.simulator.headless_driving import headless_driver, run_headless, with_start_of
    from hosts.simulator.preparation import prepare
    from hosts.simulator.run_report import RunReport

    report = RunReport(begin)
    request, manoeuvre = _drive_request(options), None
    if options.manoeuvre is not None:
        manoeuvre = load_manoeuvre(options.manoeuvre)
        request = with_start_of(request, manoeuvre)
        if late := manoeuvre.late_begin(ACTS if manoeuvre.driver else ()):
            report.show(": ".join(late))
    prepared = prepare(request, report.show)
    report.show_prepared(prepared, options.step)
    seconds = options.stop_time if options.stop_time is not None else manoeuvre.stop_time if manoeuvre else 0.0
    with _start_car(options, prepared) as started:
        car = AliasedCar(started, prepared.source)
        driver = headless_driver(car, manoeuvre, options.seed)
        report.show_ready()
        with _reported_end(started, options, report):
            try:
                good = run_headless(car, driver, seconds, report.add_event)
            except KeyboardInterrupt:
                report.show("Ended by Ctrl-C or a signal.")
                good = True
    return GOOD if good and report.is_complete else NOT_GOOD


def _drive_with_pages(options: argparse.Namespace, begin: float) -> int:
    """Drive with pages until Ctrl-C."""
    from concurrent.futures import ThreadPoolExecutor

    from hosts.simulator.access_control import AccessControl
    from hosts.simulator.aliased_car import AliasedCar
    from hosts.simulator.page_session import PageServer, drive_with_pages
    from hosts.simulator.preparation import prepare
    from hosts.simulator.run_report import RunReport
    from hosts.simulator.server_needs import Content
    from hosts.simulator.web import listening_socket
    from viewer.html_document import html_document

    report = RunReport(begin)
    with listening_socket(options.listen, options.port) as listening, ThreadPoolExecutor(1) as pool:
        page = pool.submit(html_document, _TITLE, {}, "Simulator", "'self'")  # the script may have to be built
        prepared = prepare(_drive_request(options), report.show)
        report.show_prepared(prepared, options.step)
        with _start_car(options, prepared) as started:
            car = AliasedCar(started, prepared.source)
            record = "" if options.record is None else str(options.record)
            hello = prepared.hello(car.constants, car.names, car.step, record)
            content = Content(page.result(), prepared.world.content, hello, prepared.places())
            page_server = PageServer(
                listening, AccessControl.of(options.listen), not options.no_open, not options.no_devices
            )
            with _reported_end(started, options, report):
                drive_with_pages(car, content, page_server, report)
    return GOOD if report.is_complete else NOT_GOOD
