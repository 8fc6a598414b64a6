"""What all commands have in common: arguments, table, machine line, JSON file, chart and page."""

import json
import sys
import threading
from argparse import ArgumentParser, Namespace, RawDescriptionHelpFormatter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from ali3 import bars
from ali3.command_run import run_command
from ali3.files import write_text
from benchmarks.shared.figures import between, rows_of
from benchmarks.shared.machine import conditions, describe
from benchmarks.shared.pages import DOCS, Row, machine, replace
from benchmarks.shared.tables import plain_table, write_json
from mbs.common.progress import progress_for

T = TypeVar("T")


@dataclass(frozen=True)
class Part:
    """A part of a command: what it measures or writes, and its options."""

    about: str
    """One line for the help."""
    measure: Callable[[Namespace], Sequence[Row] | None]
    """Returns the rows; None if it has written files itself and printed their paths."""
    names: Sequence[str] = ()
    """What ``--only`` chooses from, by default all."""
    options: Mapping[str, tuple[Any, str]] = field(default_factory=dict)
    """Default and help of further options; the default of a switch is False, of an optional file `Path`."""
    rows: bool = True
    """Whether `measure` returns rows, which ``--json`` writes."""
    pages: Sequence[str] = ()
    """Files in `docs/` into which ``--write`` writes the tables of `blocks`."""
    blocks: Callable[[Sequence[Row]], Mapping[str, str]] | None = None
    """Tables of the pages by the names of their marks."""
    words: Callable[[Sequence[Row]], str] | None = None
    """Text that is printed, by default the tables of `blocks`, or all columns without `blocks`."""
    chart: Callable[[Sequence[Row], Path], None] | None = None
    """Draws the rows into a PNG file, or several charts into a folder."""
    check: Callable[[Sequence[Row], Namespace], Sequence[str]] | None = None
    """Returns sentences on faults; if there are any, the exit code is 1."""
    is_default: bool = False
    """Whether this part is run when no part is named."""


def run(name: str, text: str | None, parts: Mapping[str, Part], arguments: Sequence[str] | None = None) -> int:
    """Run ``python -m benchmarks.<name> [PART]`` and return the exit code.

    A command with one part has no argument PART. With ``--from`` the rows are read from JSON files of earlier runs.
    """
    parser = ArgumentParser(
        prog=f"python -m benchmarks.{name}", description=text, formatter_class=RawDescriptionHelpFormatter
    )
    if len(parts) == 1:
        _add_options(parser, *parts.values())
        parser.set_defaults(part=next(iter(parts)))
    else:
        subparsers = parser.add_subparsers(dest="part", metavar="PART", required=True)
        for key, part in parts.items():
            _add_options(subparsers.add_parser(key, help=part.about, description=part.about), part)
    arguments = [*(sys.argv[1:] if arguments is None else arguments)]
    if arguments and arguments[0].startswith("--") and arguments[0] != "--help":
        arguments = [key for key, part in parts.items() if part.is_default and len(parts) > 1] + arguments
    options = parser.parse_args(arguments)
    part = parts[options.part]
    for key, (default, _) in part.options.items():
        value = getattr(options, key)
        if isinstance(default, (int, float)) and default > 0 and not value > 0:
            parser.error(f"--{key.replace('_', '-')} is {value}; it is a positive number.")
    return run_command(partial(_run_part, name, part, options), (RuntimeError,))


def _add_options(parser: ArgumentParser, part: Part) -> None:
    if part.names:
        parser.add_argument(
            "--only", nargs="+", choices=part.names, default=[*part.names], metavar="NAME",
            help=f"of {', '.join(part.names)}",
        )  # fmt: skip
    for key, (default, description) in part.options.items():
        flag, help_text = f"--{key.replace('_', '-')}", description.replace("%", "%%")
        if default is False:
            parser.add_argument(flag, action="store_true", help=help_text)
        elif default is Path:
            parser.add_argument(flag, type=Path, metavar="FILE", help=help_text)
        else:
            many = isinstance(default, (list, tuple))
            first = (*default, "")[0] if many else default
            default_text = " ".join(map(str, default)) if many else str(default)
            parser.add_argument(
                flag, type=type(first), nargs="+" if many else None, default=default, metavar="X",
                help=f"{help_text}; default: {default_text}" if default_text else help_text,
            )  # fmt: skip
    if part.rows:
        parser.add_argument("--json", type=Path, metavar="FILE", help="write {meta, rows}")
        parser.add_argument("--from", dest="sources", type=Path, nargs="+", metavar="FILE", help="rows of earlier runs")
    if part.chart is not None:
        parser.add_argument("--chart", type=Path, metavar="FILE", help="draw the rows (PNG), or into a folder")
    if part.blocks is not None:
        parser.add_argument("--write", action="store_true", help=f"write the tables of {', '.join(part.pages)} in docs")


def _run_part(name: str, part: Part, options: Namespace) -> int:
    sources = getattr(options, "sources", None)
    if sources:
        files = [json.loads(file.read_text(encoding="utf-8")) for file in sources]
        rows, meta = [row for file in files for row in file["rows"]], files[0]["meta"]
    else:
        result = part.measure(options)
        if result is None:
            return 0
        rows = [*result]
        recorded = {
            key: value for key, value in vars(options).items() if key in part.options or key in ("part", "only")
        }
        recorded = {key: str(value) if isinstance(value, Path) else value for key, value in recorded.items()}
        meta = describe(name, **{"repeats": 1} | recorded)
    if options.json is not None:
        write_json(options.json, meta, rows)
        print(f"written: {options.json}")
    print(f"{_text_of(part, rows)}\n\n{conditions(meta)}")
    if part.chart is not None and options.chart is not None:
        part.chart(rows, options.chart)
    faults = [] if part.check is None else part.check(rows, options)  # before a page is written that it reads
    if part.blocks is not None and options.write:
        title = options.part.replace("-", " ")
        write_blocks(part.pages, {**part.blocks(rows), f"machine {title}": machine(meta)})
    print("\n".join(faults), end="\n" if faults else "")
    return int(bool(faults))


def _text_of(part: Part, rows: Sequence[Row]) -> str:
    """The text that is printed for the rows."""
    if part.words is not None:
        return part.words(rows)
    if part.blocks is not None:
        return "\n\n".join(f"{name}\n\n{text}" for name, text in part.blocks(rows).items())
    return plain_table(rows)


def write_blocks(pages: Sequence[str], blocks: Mapping[str, str]) -> None:
    """Write tables between their marks on pages of `docs/`; the other text of the pages is unchanged."""
    for page in pages:
        file = DOCS / page
        text = file.read_text(encoding="utf-8")
        for name, content in blocks.items():
            before, now = (len(rows_of(part)) for part in (between(text, name), content))
            if now < before:
                print(f"The table '{name}' has {now} rows now and had {before}: leave --only and --quick out for all.")
        write_text(file, replace(text, blocks))
        print(f"written: {file}")


def watched(items: Sequence[T]) -> Iterator[T]:
    """Yield the items, with a progress bar on the terminal when they take longer than two seconds."""
    done = 0
    with progress_for(None) as bar:
        # the bar appears at an update only: one is due while the first item is still worked on
        first = threading.Timer(bars.DELAY + 0.1, lambda: bar.update(done / len(items)))
        first.daemon = True
        first.start()
        try:
            for done, item in enumerate(items):
                bar.update(done / len(items))
                yield item
            bar.update(1.0)
        finally:
            first.cancel()


def pyplot() -> Any:
    """Matplotlib's pyplot without a display, imported only if a chart is drawn."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    return plt


def save_chart(figure: Any, file: Path) -> None:
    """Write a figure as PNG, print the path, and close it; the same Matplotlib gives the same bytes."""
    from ali3.charts import save_picture

    save_picture(figure, file)
    print(f"written: {file}")


def report_missing(message: str) -> None:
    """Print on the error stream what is left out because it is not installed."""
    print(f"left out: {message}", file=sys.stderr)
