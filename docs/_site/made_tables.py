"""Tables of the pages that are made from the sources when the site is built, instead of a mark."""

import re
from collections.abc import Callable
from functools import cache, partial

from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

from benchmarks.car.variable_tables import blocks
from benchmarks.car.variable_tables import tables as variable_tables
from mbs.elements.tables import element_table, law_table, number_table
from mbs.kernel.header_tables import TABLE_PREFIXES, array_table, sensor_table, size_table, status_table
from mbs.vehicle.reference import tables

MARK = re.compile(r"<!-- made with the site: (.+) -->\n")


@cache
def _variables() -> dict[str, str]:
    return blocks(variable_tables())


VARIABLES = ("car inputs", "car parameters", "car outputs", "car constants")
MAKERS: dict[str, Callable[[], str]] = {
    "car file": tables,
    "elements": element_table,
    "numbers of elements": number_table,
    "laws of elements": law_table,
    "sensors": sensor_table,
    "sizes of a System": size_table,
    "statuses": status_table,
    **{f"arrays {part}".rstrip(): partial(array_table, part) for part in ("", *TABLE_PREFIXES)},
    **{name: lambda name=name: _variables()[name] for name in VARIABLES},
}


def with_tables(app: Sphinx, page: str, source: list[str]) -> None:
    """Replace each mark by what is made for it. Raises `ExtensionError` if nothing makes it."""

    def made(mark: re.Match[str]) -> str:
        if mark[1] not in MAKERS:
            raise ExtensionError(f"{page}: nothing makes {mark[1]!r}; there are {', '.join(MAKERS)}.")
        return MAKERS[mark[1]]() + "\n"

    source[0] = MARK.sub(made, source[0])


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the hook."""
    app.connect("source-read", with_tables)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
