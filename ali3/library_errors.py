"""Turns errors of a library that reads a file into one sentence."""

from collections.abc import Iterator
from contextlib import contextmanager

from ali3.errors import UserError
from ali3.extras import missing_module
from ali3.message_text import one_line


def reader_stops(error: BaseException) -> str:
    """The end of a sentence: what a library raises on a damaged file is often none."""
    first_line = (str(error).strip() or repr(error)).splitlines()[0].rstrip(".!")
    return f"it is damaged or of another format; its reader stops with '{one_line(first_line)}'."


@contextmanager
def read_by_library(name: str, error: type[Exception], what: str = "be read", extra: str = "") -> Iterator[None]:
    """Within it, whatever a library raises on a file, its end of the program too, becomes one sentence.

    `name`: of the file; `error`: what is raised; sentences of our own pass; `what`: the file cannot; `extra`: of the
    installation, named where the package is missing.
    """
    try:
        yield
    except (UserError, error):
        raise
    except ModuleNotFoundError as fault:
        raise error(f"{name} cannot {what}. {missing_module(fault, extra)}") from fault
    except (Exception, SystemExit) as fault:  # what a damaged file does to the readers is not declared
        raise error(f"{name} cannot {what}: {reader_stops(fault)}") from fault
