"""Docstrings as they are written, in plain text with names in backticks, read as reStructuredText."""

import re

from sphinx.application import Sphinx

ALIAS = re.compile(r"TypeAliasForwardRef\('(\w+)'\)")
MARKUP = re.compile(r"[|*]|(?<=\w)_(?!\w)")
CODE = re.compile(r"(``.+?``|`[^`]+`)")


def escaped(line: str) -> str:
    """`line` with the characters escaped that reStructuredText would take for markup, outside of code."""
    segments = CODE.split(line)
    segments[::2] = [MARKUP.sub(r"\\\g<0>", segment) for segment in segments[::2]]
    return "".join(segments)


def plain(app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]) -> None:
    """Escape a docstring in place; examples stay."""
    lines[:] = [line if line.lstrip().startswith((">>>", "..", ":")) else escaped(line) for line in lines]


def signature(
    app: Sphinx, what: str, name: str, obj: object, options: object, arguments: str | None, returned: str | None
) -> tuple[str | None, str | None]:
    """Names of type aliases as they are written in the source."""
    return tuple(text and ALIAS.sub(r"\1", text) for text in (arguments, returned))  # type: ignore[return-value]


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the hooks; docstrings are changed before the sections of NumPy style are read."""
    app.connect("autodoc-process-docstring", plain, priority=400)
    app.connect("autodoc-process-signature", signature)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
