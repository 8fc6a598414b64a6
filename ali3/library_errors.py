"""Turns errors of libraries that read files into sentences."""

from collections.abc import Iterator
from contextlib import contextmanager

from ali3.errors import UserError
from ali3.extras import missing_module
from ali3.message_text import one_line


def reader_stops(error: BaseException) -> str:
    """The end of a sentence from an error of a library, whose message is often no sentence."""
    first_line = (str(error).strip() or repr(error)).splitlines()[0].rstrip(".!")
    return f"it is damaged or of another format; its reader stops with '{one_line(first_line)}'."


@contextmanager
def read_by_library(name: str, error: type[Exception], what: str = "be read", extra: str = "") -> Iterator[None]:
    """Context in which every error of a library, also `SystemExit`, becomes one sentence.

    `name`: of the file; `error`: the error that is raised; errors of this type pass unchanged; `what`: predicate after
    "cannot"; `extra`: of the installation, named if the package is missing.
    """
    try:
        yield
    except (UserError, error):
        raise
    except ModuleNotFoundError as fault:
        raise error(f"{name} cannot {what}. {missing_module(fault, extra)}") from fault
    except (Exception, SystemExit) as fault:  # libraries do not declare their errors on damaged files
        raise error(f"{name} cannot {what}: {reader_stops(fault)}") from fault
