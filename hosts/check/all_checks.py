"""All checks of an FMU; each runs in an isolated process, which a faulty FMU may crash."""

import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ali3.errors import UserError
from ali3.isolated_processes import Lost
from hosts.check import behaviour, dependencies, documents, portability, process_settings, process_state, values
from hosts.check.documents import FUNCTIONS
from hosts.check.instance import Check, Finding, NotInstantiatedError, Subject, open_subject
from hosts.common.numbers import Value

_ROOMS = (documents, process_settings, process_state, behaviour, values, dependencies, portability)
CHECKS: tuple[Check, ...] = tuple(
    sorted(
        (found for room in _ROOMS for found in vars(room).values() if isinstance(found, Check)),
        key=lambda check: check.crash == "note",
    )
)
"""Those of process settings come before all others with calls, as no later check can restore the settings.

Last those with calls that FMI does not allow, because these may corrupt the memory of the FMU.
"""


@dataclass
class Checker:
    """Runs one of `CHECKS` by its index; each process unpacks the FMU once.

    `fmu`: absolute path; `steps`: communication steps per run; `start`: start values of each instance.
    """

    fmu: Path
    steps: int
    start: Mapping[str, Value]
    _subject: list[Subject] = field(default_factory=list)

    def __call__(self, index: int, tell: Callable[[float], None]) -> Finding:
        if not self._subject:
            folder = Path(tempfile.mkdtemp(prefix="fmu_"))  # removed with the folder of the process
            self._subject.append(open_subject(self.fmu, folder, self.steps, self.start))
        return run_check(CHECKS[index], self._subject[0])


def run_check(check: Check, subject: Subject) -> Finding:
    """The finding of a check; an exception is a bad one."""
    try:
        return check.find(subject)
    except (ModuleNotFoundError, MemoryError):
        raise
    except NotInstantiatedError as error:
        return Finding("bad", str(error), last=check.crash == "bad")
    except UserError as error:
        return Finding("bad", str(error).rstrip("."))
    except Exception as error:
        return Finding("bad", f"ended with {type(error).__name__}: {error}")


def finding_of_loss(check: Check, loss: Lost, limit: float) -> Finding:
    """The finding of a check whose process has ended or has exceeded a time, s."""
    verdict = check.crash if not loss.late else check.late if check.calls else "note"
    open_by = f" ({check.clause})" if verdict == "note" and check.clause else ""
    if loss.late:
        message = f"{loss.how}{open_by}; --time-limit gives a check more than {limit:g} s"
    else:
        message = f"the process {loss.how}{open_by}"
    return Finding(verdict, message, last=check.name == FUNCTIONS)
