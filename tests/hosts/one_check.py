"""Verdicts of `ali3 check`: of the command, and of one check in a forked process, without a start of Python."""

import json
import os
import tempfile
from contextlib import suppress
from pathlib import Path

from ali3.temporary_folder import temporary_folder
from hosts.check.all_checks import CHECKS, run_check
from hosts.check.command import main
from hosts.check.instance import open_subject
from tests.forked import forked
from tests.in_process import run


def one_check(fmu: Path, name: str, steps: int = 10) -> tuple[str, str]:
    """Verdict and words of a check; what the FMU does to its process ends with that."""
    (check,) = (check for check in CHECKS if check.name == name)
    with temporary_folder() as folder:

        def verdict_and_words() -> str:
            os.chdir(folder)
            tempfile.tempdir = str(folder)
            finding = run_check(check, open_subject(fmu, folder / "fmu", steps, {}))
            with suppress(ChildProcessError):
                while True:
                    os.wait()
            return json.dumps([finding.verdict, finding.words])

        text, code = forked(verdict_and_words)
    assert code == 0, text or f"the process of the check {name} ended with {code}"
    verdict, words = json.loads(text)
    return verdict, words


def all_checks(fmu: Path, *options: object) -> tuple[int, dict[str, tuple[str, str]]]:
    """Exit code of the command, and verdict and words by the name of the check."""
    done = run(main, fmu, *options)
    lines = [line for line in done.stdout.splitlines() if line[:4].strip() in ("ok", "note", "BAD")]
    return done.returncode, {line[6:28].strip(): (line[:4].strip(), line[30:]) for line in lines}
