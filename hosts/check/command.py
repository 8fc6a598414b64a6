"""Checks a co-simulation FMU (FMI 2.0 or 3.0) and prints a verdict: ``ali3 check FMU``."""

from __future__ import annotations

import argparse
import signal
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.running import INTERRUPTED, module_command, run_command
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.common.options import Wishes, add_setting_options, wishes

if TYPE_CHECKING:
    from hosts.check.instance import Finding, Subject
    from hosts.fmu.settings import Settings

_MARKS = {"good": "ok", "note": "note", "bad": "BAD"}
_WIDTH = 22
_MOST_STEPS = 100_000


def main(arguments: Sequence[str] | None = None, prog: str = "python -m hosts.check.command") -> int:
    """Run the command, which the user typed as `prog`; 0 if nothing bad was found."""
    parser = argparse.ArgumentParser(prog=prog, description="Check an FMU and print a verdict.")
    parser.add_argument("fmu", type=Path, metavar="FMU")
    parser.add_argument("--steps", type=int, default=50, metavar="N", help="communication steps per run; default: 50")
    parser.add_argument("--inside", type=Path, help=argparse.SUPPRESS)
    add_setting_options(parser)
    options = parser.parse_args(arguments)
    if not 1 <= options.steps <= _MOST_STEPS:
        parser.error(f"the number of steps is {options.steps}; it must be from 1 to {_MOST_STEPS}")
    if options.inside is None:
        return run_command(lambda: _outside(options.fmu, options.steps, wishes(options)))
    # Ctrl-C reaches both processes: the outer one says so and ends this one.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    return run_command(lambda: _inside(options.fmu, options.steps, options.inside, wishes(options)))


def _inside(fmu: Path, steps: int, folder: Path, given: Wishes) -> int:
    start = _settings(fmu, given).start if given else {}
    findings = check(fmu, folder, steps, print_finding, start)
    bad = sum(f.verdict == "bad" for f in findings)
    print(f"\n{fmu}: {'nothing bad found' if not bad else f'{bad} bad'}")
    return 1 if bad else 0


def _settings(fmu: Path, given: Wishes) -> Settings:
    from hosts.fmu.fmu import described
    from hosts.fmu.settings import settings_of
    from hosts.fmu.variables import Variables

    return settings_of(Variables(described(fmu)), given)


def _outside(fmu: Path, steps: int, given: Wishes) -> int:
    """The checks in a process of their own, which a broken FMU may take down."""
    if fmu.is_dir():
        raise HostError(f"{fmu} is a folder; an FMU is a file.")
    if not fmu.is_file():
        raise HostError(f"There is no file {fmu}.")
    if not zipfile.is_zipfile(fmu):
        raise HostError(f"{fmu} is not an FMU (not a zip archive).")
    if given:
        for name, words in _settings(fmu, given).rows():
            print(f" set  {name:<{_WIDTH}}  {words}", flush=True)
    with tempfile.TemporaryDirectory(prefix="fmu_", ignore_cleanup_errors=True) as folder:
        command = module_command(
            "hosts.check.command", str(fmu), "--steps", str(steps), "--inside", folder, *given.arguments
        )
        status = subprocess.run(command, check=False).returncode
    if status in (0, 1, 2):
        return status
    if status == INTERRUPTED:
        raise KeyboardInterrupt
    print(f"{_MARKS['bad']:>4}  {'stays alive':<{_WIDTH}}  the process that ran the next check ended with {status}")
    print(f"\n{fmu}: bad")
    return 1


def check(
    fmu: Path,
    folder: Path,
    steps: int = 50,
    say: Callable[[Finding], None] = lambda finding: None,
    start: Mapping[str, Value] | None = None,
) -> list[Finding]:
    """All checks.

    Parameters
    ----------
    fmu : Path
    folder : Path
        Where it is unpacked.
    steps : int
        Communication steps per run.
    say : callable
        Called with each finding at once.
    start : mapping of str to float, int, bool or str, optional
        What is set in each instance before it starts.

    Returns
    -------
    list of Finding
        In the order of the checks.
    """
    from hosts.check.behaviour import BEHAVIOUR_CHECKS
    from hosts.check.documents import DOCUMENT_CHECKS
    from hosts.check.instance import open_subject
    from hosts.check.portability import PORTABILITY_CHECKS

    findings: list[Finding] = []
    subject = open_subject(fmu, folder, steps, start or {})
    for name, function in (*DOCUMENT_CHECKS, *BEHAVIOUR_CHECKS, *PORTABILITY_CHECKS):
        findings.append(_one(name, function, subject))
        say(findings[-1])
    return findings


def print_finding(finding: Finding) -> None:
    """One line of the verdict."""
    print(f"{_MARKS[finding.verdict]:>4}  {finding.check:<{_WIDTH}}  {finding.words}", flush=True)


def _one(name: str, function: Callable[[Subject], Finding], subject: Subject) -> Finding:
    from hosts.check.instance import Finding

    try:
        return function(subject)
    except ModuleNotFoundError:
        raise
    except Exception as error:
        return Finding(name, "bad", f"ended with {type(error).__name__}: {error}")


if __name__ == "__main__":
    sys.exit(main())
