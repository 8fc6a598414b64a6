"""All checks of an FMU, as work for a process: a broken FMU may take it down."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.processes import memory_words
from hosts.common.numbers import Value

if TYPE_CHECKING:
    from hosts.check.instance import Finding, Subject


def check(task: tuple[Path, int, Mapping[str, Value]], tell: Callable[[Finding], None]) -> int:
    """Do all checks.

    `task`: the FMU, communication steps per run, and what is set in each instance before it starts; `tell`: called with
    each finding at once. Returns how many findings are bad.
    """
    from hosts.check.behaviour import BEHAVIOUR_CHECKS
    from hosts.check.documents import DOCUMENT_CHECKS
    from hosts.check.instance import open_subject
    from hosts.check.portability import PORTABILITY_CHECKS

    fmu, steps, start = task
    bad = 0
    with tempfile.TemporaryDirectory(prefix="fmu_", ignore_cleanup_errors=True) as folder:
        subject = open_subject(fmu, Path(folder), steps, start)
        for name, function in (*DOCUMENT_CHECKS, *BEHAVIOUR_CHECKS, *PORTABILITY_CHECKS):
            finding = _one(name, function, subject)
            bad += finding.verdict == "bad"
            tell(finding)
    return bad


def _one(name: str, function: Callable[[Subject], Finding], subject: Subject) -> Finding:
    from hosts.check.instance import Finding

    try:
        return function(subject)
    except (ModuleNotFoundError, MemoryError):
        raise
    except Exception as error:
        return Finding(name, "bad", f"ended with {type(error).__name__}: {error}{memory_words()}")
