"""Checks a co-simulation FMU (FMI 2.0 or 3.0) and prints a verdict: ``python -m hosts.check FMU``."""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path

from hosts.errors import HostError
from hosts.fmu_checks.behaviour import BEHAVIOUR_CHECKS
from hosts.fmu_checks.documents import DOCUMENT_CHECKS
from hosts.fmu_checks.instance import Finding, Subject, open_subject
from hosts.fmu_checks.portability import PORTABILITY_CHECKS

_MARKS = {"good": "ok", "note": "note", "bad": "BAD"}
_WIDTH = 22


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; 0 if nothing bad was found."""
    parser = argparse.ArgumentParser(prog="python -m hosts.check", description="Check an FMU and print a verdict.")
    parser.add_argument("fmu", type=Path, metavar="FMU")
    parser.add_argument("--steps", type=int, default=50, metavar="N", help="communication steps per run; default: 50")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.steps < 1:
        parser.error("the number of steps is positive")
    if not options.inside:
        return _outside(options.fmu, options.steps)
    try:
        findings = check(options.fmu, options.steps, print_finding)
    except HostError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    bad = sum(f.verdict == "bad" for f in findings)
    print(f"\n{options.fmu}: {'nothing bad found' if not bad else f'{bad} bad'}")
    return 1 if bad else 0


def _outside(fmu: Path, steps: int) -> int:
    """The checks in a process of their own, which a broken FMU may take down."""
    command = [sys.executable, "-m", "hosts.check", str(fmu), "--steps", str(steps), "--inside"]
    status = subprocess.run(command, check=False).returncode
    if status in (0, 1, 2):
        return status
    print_finding(Finding("stays alive", "bad", f"the process that ran the next check ended with {status}"))
    print(f"\n{fmu}: bad")
    return 1


def check(fmu: Path, steps: int = 50, say: Callable[[Finding], None] = lambda finding: None) -> list[Finding]:
    """All checks.

    Parameters
    ----------
    fmu : Path
    steps : int
        Communication steps per run.
    say : callable
        Is told each finding at once.

    Returns
    -------
    list of Finding
        In the order of the checks.
    """
    if not fmu.is_file():
        raise HostError(f"There is no file {fmu}.")
    if not zipfile.is_zipfile(fmu):
        raise HostError(f"{fmu} is not an FMU (not a zip archive).")
    findings: list[Finding] = []
    with tempfile.TemporaryDirectory(prefix="fmu_", ignore_cleanup_errors=True) as folder:
        subject = open_subject(fmu, Path(folder), steps)
        for name, function in (*DOCUMENT_CHECKS, *BEHAVIOUR_CHECKS, *PORTABILITY_CHECKS):
            findings.append(_one(name, function, subject))
            say(findings[-1])
    return findings


def print_finding(finding: Finding) -> None:
    """One line of the verdict."""
    print(f"{_MARKS[finding.verdict]:>4}  {finding.check:<{_WIDTH}}  {finding.words}", flush=True)


def _one(name: str, function: Callable[[Subject], Finding], subject: Subject) -> Finding:
    try:
        return function(subject)
    except Exception as error:
        return Finding(name, "bad", f"ended with {type(error).__name__}: {error}")


if __name__ == "__main__":
    sys.exit(main())
