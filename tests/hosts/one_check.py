"""One check of `ali3 check` in a forked process: without a start of Python and without the other checks."""

import json
import os
import tempfile
import traceback
import warnings
from contextlib import suppress
from pathlib import Path

from hosts.check.all_checks import CHECKS, done
from hosts.check.instance import open_subject


def one_check(fmu: Path, name: str, steps: int = 10) -> tuple[str, str]:
    """Verdict and words of a check; what the FMU does to its process ends with that."""
    (check,) = (check for check in CHECKS if check.name == name)
    folder = Path(tempfile.mkdtemp())
    read, write = os.pipe()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of threads in this process
        child = os.fork()
    if child == 0:
        answer: tuple[str, str]
        try:
            os.chdir(folder)
            tempfile.tempdir = str(folder)
            finding = done(check, open_subject(fmu, folder / "fmu", steps, {}))
            answer = finding.verdict, finding.words
        except BaseException:
            answer = "error", traceback.format_exc()
        os.write(write, json.dumps(answer).encode())
        with suppress(ChildProcessError):
            while True:
                os.wait()
        os._exit(0)
    os.close(write)
    with os.fdopen(read, "rb") as stream:
        text = stream.read()
    os.waitpid(child, 0)
    assert text, f"the process of the check {name} ended without a verdict"
    verdict, words = json.loads(text)
    return verdict, words
