"""Films and pictures of the documentation: ``python -m benchmarks.pictures PART``.

All are drawn by a headless browser. Needs Chromium, Chrome or Edge, and
``pip install "ali3[pictures,viewer]"``, the simulator also the extra ``simulator``.
"""

import sys
from argparse import Namespace
from functools import partial
from pathlib import Path

from ali3.files import make_folder
from benchmarks.pictures import pages, simulator
from benchmarks.pictures.animations import ANIMATIONS, film
from benchmarks.shared.command import Part, run

OUT = {"out": ("out", "folder")}


def _films(options: Namespace) -> None:
    make_folder(Path(options.out))
    total = 0
    for name in options.only:
        written = film(name, Path(options.out, f"{name}.webp"))
        total += written.size
        summary = f"{written.frames} pictures, {written.duration:.1f} s, {written.size / 1000:.0f} kB"
        print("\n  ".join([f"{written.path}  {summary}", *written.notes]), flush=True)
    print(f"{len(options.only)} files, {total / 1e6:.1f} MB")


PARTS = {
    "films": Part(
        "animated WebP files of some seconds of every scene; all of them take ten minutes on two cores",
        _films,
        names=tuple(ANIMATIONS),
        options=OUT,
        rows=False,
    ),
    "simulator": Part(
        "the simulator as the prototype is driven, with its instruments, whose rates are measured on this machine",
        lambda options: simulator.take_all(options.only, Path(options.out)),
        names=tuple(simulator.SHOTS),
        options=OUT,
        rows=False,
    ),
    "pages": Part(
        "pages of all kinds at one instant; with another checkout, how many pixels differ when its script draws them",
        pages.compare,
        names=tuple(pages.PAGES),
        options=OUT | {"other": (Path, "folder of another checkout")},
    ),
}

main = partial(run, "pictures", __doc__, PARTS)

if __name__ == "__main__":
    sys.exit(main())
