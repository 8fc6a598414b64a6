"""Stability of the methods: ``python -m benchmarks.stability [--only SCENE ...]``.

A map over step and penalty (or Baumgarte's factor) for each method and scene: fine, wrong, refused or diverged.
"""

import sys
from argparse import Namespace
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.methods.stability import SCENES, measure, stability_blocks
from benchmarks.methods.stability_chart import draw
from benchmarks.references.cases import CASES
from benchmarks.shared.coarse_runs import expected_errors
from benchmarks.shared.command import Part, run
from benchmarks.shared.pages import Row


@expected_errors()
def _maps(options: Namespace) -> list[dict[str, Any]]:
    return [row for scene in options.only for row in measure(scene, options.quick)]


def _draw(rows: Sequence[Row], folder: Path) -> None:
    for scene in dict.fromkeys(row["scene"] for row in rows):
        title = f"{CASES[scene].title} (whole motion, {CASES[scene].end:g} s)"
        draw([row for row in rows if row["scene"] == scene], title, folder / f"stability_{scene}.png")


PARTS = {
    "stability": Part(
        "maps of all scenes",
        _maps,
        names=SCENES,
        options={"quick": (False, "few points of each scene")},
        pages=("stability.md",),
        blocks=stability_blocks,
        chart=_draw,
    )
}

main = partial(run, "stability", __doc__, PARTS)

if __name__ == "__main__":
    sys.exit(main())
