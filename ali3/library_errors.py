"""Turns errors of libraries that read files into sentences."""

from collections.abc import Iterator
from contextlib import contextmanager

from ali3.errors import UserError
from ali3.extras import missing_module
from ali3.message_text import one_line


def reader_failure(error: BaseException) -> str:
    """End of a message about an error of a library, whose own text is rarely a sentence."""
    first_line = (str(error).strip() or repr(error)).splitlines()[0].rstrip(".!")
    return f"it is damaged or of another format; its reader stops with '{one_line(first_line)}'."


@contextmanager
def read_by_library(name: str, error: type[Exception], predicate: str = "be read", extra: str = "") -> Iterator[None]:
    """Context in which every error of a library, including `SystemExit`, becomes one sentence.

    `name`: name of the file; `error`: raised type, which passes unchanged; `predicate`: words after "cannot"; `extra`:
    extra that is named if the package is not installed.
    """
    try:
        yield
    except (UserError, error):
        raise
    except ModuleNotFoundError as fault:
        raise error(f"{name} cannot {predicate}. {missing_module(fault, extra)}") from fault
    except (Exception, SystemExit) as fault:  # libraries do not declare their errors on damaged files
        raise error(f"{name} cannot {predicate}: {reader_failure(fault)}") from fault
