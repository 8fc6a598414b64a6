"""Errors of refused calls of the kernel, and sentences for their statuses."""

import ctypes
import math
from collections.abc import Mapping, Sequence

from ..header.enumerations import Cause
from ..header.limits import OPEN
from .library import load_library


class KernelError(RuntimeError):
    """A call that the kernel refused.

    Attributes
    ----------
    status : int
        Code of `ali3_status`.
    message : str
        One sentence.
    """

    def __init__(self, status: int, message: str) -> None:
        super().__init__(message)
        self.status = status
        self.message = message


def open_row(report: Mapping[str, float], names: Sequence[str]) -> str:
    """Name and gap of the row with the largest violation; empty if it is closed or its violation is not finite."""
    row, violation = int(report["worst_row"]), report["violation"]
    if not (0 <= row < len(names) and OPEN < violation < math.inf):
        return ""
    return f"'{names[row]}', open by {violation:.3g} m"


def status_text(library: ctypes.CDLL, status: int) -> str:
    """The kernel's sentence for a status."""
    return f"{library.ali3_status_text(status).decode()}."


def status_remedy(status: int) -> str:
    """The kernel's remedy for a status, a sentence; may be empty."""
    remedy: bytes = load_library().ali3_status_remedy(status)
    return remedy.decode()


def creation_error(library: ctypes.CDLL, status: int, failed_call: str, reason: str = "") -> KernelError:
    """Error for an object that could not be created; `reason`: sentence, by default that of the status."""
    return KernelError(status, f"{failed_call}: {reason or status_text(library, status)} {status_remedy(status)}")


def status_cause(status: int) -> Cause:
    """Cause of a refusal with a status."""
    return Cause(load_library().ali3_status_cause(status))
