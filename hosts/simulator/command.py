"""The driving simulator: ``ali3 simulator [FMU] [--world NAME-or-FILE] [--headless --seconds N]``."""

from __future__ import annotations

import argparse
import importlib.util
import signal
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.extras import missing_package
from ali3.running import GOOD, NOT_GOOD, run_command
from hosts.common.errors import HostError
from hosts.common.numbers import number
from hosts.common.options import add_setting_options, wishes
from hosts.driving.manoeuvres import manoeuvre_names

if TYPE_CHECKING:
    from hosts.driving.manoeuvre import Manoeuvre
    from hosts.simulator.car import Car
    from hosts.simulator.preparation import Asked, Prepared
    from hosts.simulator.run_report import RunReport

_LOCAL = "127.0.0.1"
_LONGEST = 1e6
_TITLE = "ALi3: take the wheel"


def main(arguments: Sequence[str] | None = None, prog: str = "python -m hosts.simulator") -> int:
    """Run the command, which the user typed as `prog`; 0 unless a run without a page had a refused step."""
    begin = time.monotonic()
    options = _parser(prog).parse_args(arguments)
    return run_command(lambda: _simulate(options, begin))


def _parser(prog: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=prog,
        description="Drive an FMU in real time: from a page in the browser, by keys, gamepad or a steering wheel. "
        "Ctrl-C ends with a report of the step times.",
    )
    parser.add_argument(
        "fmu",
        nargs="?",
        type=Path,
        metavar="FMU",
        help="FMI 2.0 co-simulation; default: dist/PrototypeCar.fmu, or one that is built and kept",
    )
    parser.add_argument("--world", metavar="NAME|FILE", help="a world, see ali3 world; default: proving_ground")
    parser.add_argument("--place", metavar="NAME", help="of the world, where the car starts; default: its first")
    parser.add_argument(
        "--step", type=number, default=0.002, metavar="H", help="communication step in s; default: 0.002"
    )
    parser.add_argument("--fidelity", type=number, metavar="N", help="how much model, where the FMU offers a choice")
    add_setting_options(parser)
    parser.add_argument(
        "--aliases",
        type=Path,
        metavar="FILE",
        help="our names for those of another program: a TOML file, or chrono, carmaker, ...",
    )
    parser.add_argument("--record", type=Path, metavar="DIR", help="record inputs and outputs of every step there")
    page = parser.add_argument_group("with a page")
    page.add_argument("--port", type=int, metavar="N", help="of the server; default: the first free one from 8765 on")
    page.add_argument(
        "--listen",
        default=_LOCAL,
        metavar="ADDRESS",
        help="address that the server listens on; default: 127.0.0.1, which only this machine reaches",
    )
    page.add_argument("--no-open", action="store_true", help="do not open a browser")
    page.add_argument("--no-devices", action="store_true", help="do not read wheels and gamepads of this machine")
    alone = parser.add_argument_group("without a page")
    alone.add_argument("--headless", action="store_true", help="no page; the run ends by itself")
    alone.add_argument("--seconds", type=number, metavar="N", help="simulated time; default: that of the manoeuvre")
    alone.add_argument(
        *("--manoeuvre", "-m"),
        metavar="NAME|CSV",
        help=f"table of inputs over time, or one of: {', '.join(manoeuvre_names())}",
    )
    alone.add_argument("--wild", type=int, metavar="SEED", help="a driver without sense moves the inputs")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the report")
    return parser


def _simulate(options: argparse.Namespace, begin: float) -> int:
    from ali3.files import check_writable

    _check(options)
    if options.json is not None:
        check_writable(options.json)
    manoeuvre = _manoeuvre(options)
    if options.headless:
        return _alone(options, begin, manoeuvre)
    return _with_pages(options, begin)


def _check(options: argparse.Namespace) -> None:
    """Options that do not go together, and packages that are missing."""
    for package in ("fmpy",) if options.headless else ("fmpy", "websockets"):
        if importlib.util.find_spec(package) is None:
            raise HostError(missing_package(package))
    if not 0.0 < options.step <= 1.0:
        raise HostError(f"The step is {options.step:g} s; it must be positive and at most 1 s.")
    alone = {"--seconds": options.seconds, "--manoeuvre": options.manoeuvre, "--wild": options.wild}
    given = [name for name, value in alone.items() if value is not None]
    if given and not options.headless:
        raise HostError(f"{given[0]} is for a run without a page; add --headless, or leave it out and end with Ctrl-C.")
    if options.headless and options.seconds is None and options.manoeuvre is None:
        raise HostError("A run without a page needs its length: --headless --seconds N, or a --manoeuvre.")
    if options.seconds is not None and not 0.0 < options.seconds <= _LONGEST:
        raise HostError(f"--seconds is {options.seconds:g}; it must be positive and at most {_LONGEST:g}.")
    if options.manoeuvre is not None and options.wild is not None:
        raise HostError("Inputs are given by --manoeuvre and by --wild; give one of them.")


def _manoeuvre(options: argparse.Namespace) -> Manoeuvre | None:
    if options.manoeuvre is None:
        return None
    from hosts.recordings.load_manoeuvre import load_manoeuvre

    return load_manoeuvre(options.manoeuvre)


def _asked(options: argparse.Namespace, manoeuvre: Manoeuvre | None = None) -> Asked:
    from hosts.simulator.preparation import Asked

    names = ("fmu", "world", "place", "fidelity", "aliases", "record")
    return Asked(**{name: getattr(options, name) for name in names}, wishes=wishes(options), manoeuvre=manoeuvre)


def _started(options: argparse.Namespace, prepared: Prepared) -> Car:
    from hosts.simulator.car import Car, CarSettings

    return Car(
        CarSettings(
            prepared.fmu.path,
            prepared.settings.start,
            options.step,
            record=options.record,
            world=prepared.world.name or None,
            seed=options.wild,
        )
    )


@contextmanager
def _reported(car: Car, options: argparse.Namespace, report: RunReport) -> Iterator[None]:
    """At the end the car is closed, and what is then still to be said of its recording and the report are shown."""
    try:
        yield
    finally:
        if options.record is not None:
            report.tell(f"The recording {options.record} is put together ...")
        try:
            car.close()
        finally:
            with suppress(HostError):  # a car that has ended by itself has been told of
                for event in car.events():
                    report.event(event.kind, event.text)
            report.finish(car.step_times(), options.json)


@contextmanager
def _interrupted_by_sigterm() -> Iterator[None]:
    """What ends programs from outside, such as `timeout` or a container, ends the run as Ctrl-C does."""
    if threading.current_thread() is not threading.main_thread():  # Python has signals in the main thread only
        yield
        return
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _alone(options: argparse.Namespace, begin: float, manoeuvre: Manoeuvre | None) -> int:
    """Without a page; the run ends by itself."""
    from hosts.simulator.aliased_car import AliasedCar
    from hosts.simulator.headless import headless_driver, run_headless
    from hosts.simulator.preparation import prepare
    from hosts.simulator.run_report import RunReport

    report = RunReport(begin)
    prepared = prepare(_asked(options, manoeuvre), report.tell)
    report.prepared(prepared, options.step)
    seconds = options.seconds if options.seconds is not None else manoeuvre.stop_time if manoeuvre else 0.0
    with _started(options, prepared) as started:
        car = AliasedCar(started, prepared.aliases)
        driver = headless_driver(car, manoeuvre, options.wild)
        report.ready()
        with _reported(started, options, report):
            try:
                with _interrupted_by_sigterm():
                    good = run_headless(car, driver, seconds, report.event)
            except KeyboardInterrupt:
                report.tell("Ended by Ctrl-C or a signal.")
                good = True
    return GOOD if good and report.whole else NOT_GOOD


def _with_pages(options: argparse.Namespace, begin: float) -> int:
    """Until Ctrl-C."""
    from concurrent.futures import ThreadPoolExecutor

    from hosts.simulator.aliased_car import AliasedCar
    from hosts.simulator.guard import Guard
    from hosts.simulator.preparation import prepare
    from hosts.simulator.run_report import RunReport
    from hosts.simulator.server_needs import Content
    from hosts.simulator.web import listening_socket
    from hosts.simulator.with_page import Opened, drive_with_pages
    from viewer.simulator_page import simulator_html

    report = RunReport(begin)
    with listening_socket(options.listen, options.port) as listening, ThreadPoolExecutor(1) as pool:
        page = pool.submit(simulator_html, _TITLE)  # a clone may have to build its script
        prepared = prepare(_asked(options), report.tell)
        report.prepared(prepared, options.step)
        with _started(options, prepared) as started:
            car = AliasedCar(started, prepared.aliases)
            record = "" if options.record is None else str(options.record)
            hello = prepared.hello(car.constants, car.names, car.step, record)
            content = Content(page.result(), prepared.world.content, hello, prepared.places())
            opened = Opened(listening, Guard.of(options.listen), not options.no_open, not options.no_devices)
            with _reported(started, options, report):
                drive_with_pages(car, content, opened, report)
    return GOOD if report.whole else NOT_GOOD
