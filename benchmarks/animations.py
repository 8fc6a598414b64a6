"""Films of the scenes for the documentation: ``python -m benchmarks.animations [--out DIR] [--only NAME ...]``.

Every scene is run and filmed in the page that draws, by a Chromium without a window: animated WebP files of some
seconds. All of them take about ten minutes on two cores. Needs a Chromium, Chrome or Edge, and
``pip install "ali3[pictures,viewer]"``. The pictures of the documentation are
``python -m benchmarks.animations --out docs/images/animations``.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from ali3.files import make_folder
from ali3.running import run_command
from benchmarks.paper.animations import ANIMATIONS, film
from benchmarks.shared.command import parser_of


def main(arguments: Sequence[str] | None = None) -> int:
    """Film each, say where and how large."""
    parser = parser_of("animations", __doc__, json=False)
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR", help="folder; default: out")
    parser.add_argument(
        "--only", nargs="+", choices=[*ANIMATIONS], default=[*ANIMATIONS], metavar="NAME", help=", ".join(ANIMATIONS)
    )
    parser.add_argument("--suffix", choices=["webp", "gif", "mp4"], default="webp", help="kind of the files")
    options = parser.parse_args(arguments)
    make_folder(options.out)
    total = 0
    for name in options.only:
        written = film(name, options.out / f"{name}.{options.suffix}")
        total += written.size
        print(
            f"{written.path}  {written.frames} pictures, {written.duration:.1f} s, {written.size / 1000:.0f} kB",
            flush=True,
        )
        for note in written.notes:
            print(f"  {note}")
    print(f"{len(options.only)} files, {total / 1e6:.1f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
