"""What the commands share: arguments, progress, pictures and files."""

from __future__ import annotations

import argparse
import threading
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from benchmarks.shared.machine import conditions, describe
from benchmarks.shared.tables import write_json
from mbs.common.progress import DELAY, progress_for

T = TypeVar("T")


def parser_of(name: str, text: str | None, *, json: bool = True, chart: str | None = None) -> argparse.ArgumentParser:
    """Parser of ``python -m benchmarks.<name>``.

    `json`: with the option ``--json FILE``; `chart`: what the option ``--chart FILE`` draws; without it there is none.
    """
    parser = argparse.ArgumentParser(
        prog=f"python -m benchmarks.{name}", description=text, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    if json:
        parser.add_argument("--json", type=Path, metavar="FILE", help="write {meta, rows}")
    if chart is not None:
        parser.add_argument("--chart", type=Path, metavar="FILE", help=f"draw {chart} (PNG)")
    return parser


def watched(items: Sequence[T]) -> Iterator[T]:
    """The items one after the other, with a bar on the terminal when they take longer than two seconds."""
    done = 0
    with progress_for(None) as bar:
        # the bar shows itself when it is told: also while the first item takes all the time
        first = threading.Timer(DELAY + 0.1, lambda: bar.update(done / len(items)))
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
    """Matplotlib without a screen, loaded only where something is drawn."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    return plt


def save_chart(figure: Any, file: Path) -> None:
    """Write a figure as PNG, say where, and close it; the same figure gives the same bytes with the same Matplotlib."""
    from ali3.charts import save_picture

    save_picture(figure, file)
    print(f"written: {file}")


def save_rows(file: Path | None, benchmark: str, rows: Sequence[Mapping[str, Any]], **more: Any) -> None:
    """Print under which conditions was measured; write ``{"meta": ..., "rows": [...]}`` if a file was asked for.

    `more`: as of `benchmarks.shared.machine.describe`.
    """
    meta = describe(benchmark, **more)
    print(f"\n{conditions(meta)}")
    if file is not None:
        write_json(file, meta, rows)
        print(f"written: {file}")
