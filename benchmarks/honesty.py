"""Whether a run reports that it is wrong: ``python -m benchmarks.honesty PART``.

The true error of a run beside its estimate, as `mbs.simulate` makes it at coarse and fine steps. A run is wrong when a
judged sensor is off by more than 5 % of the largest range in its unit at one of 51 instants, under a tolerance beyond
ten of it; a warning then is right, and is a false alarm elsewhere. Truth is an exact motion, for random mechanisms
Newton and Euler's equations and for random machines their equations under DOP853, for cars another method.
"""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from functools import partial
from typing import Any

from benchmarks.methods import honesty, random_honesty
from benchmarks.methods.honesty_scenes import SCENES
from benchmarks.shared.command import Part, run, watched
from benchmarks.shared.pages import Row, table


def _scenes(options: Namespace) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = []
    for name in watched(list(honesty.QUICK) if options.quick else options.only):
        for method in ["ali3p"] if options.quick else SCENES[name].methods():
            for h in honesty.QUICK[name] if options.quick else SCENES[name].steps:
                rows.append(honesty.measure(name, method, h))
                if rows[-1]["cpu_s"] > honesty.LONG:
                    break
    return rows


def _random(family: str, options: Namespace) -> list[dict[str, Any]]:
    return list(random_honesty.rows_of(options.seed, watched(range(options.number)), family))


def _said(rows: Sequence[Row]) -> str:
    none = sum(row["verdict"] == "none" for row in rows)
    shown = [row for row in rows if row["verdict"] in random_honesty.TOLD]
    cases = table(shown, random_honesty.COLUMNS) if shown else "none against the rule"
    counts = table(random_honesty.summary(rows), random_honesty.SUMMARY)
    return f"{cases}\n\n{counts}\n\n{none} without a reference: two runs of it did not agree."


DRAWN = {"number": (20, "how many are drawn"), "seed": (1, "of the random numbers")}
PARTS = {
    "scenes": Part(
        "every scene, method and manoeuvre of the prototype",
        _scenes,
        names=tuple(SCENES),
        options={"quick": (False, "three scenes, the default method, a few steps")},
        pages=("accuracy.md",),
        blocks=honesty.honesty_blocks,
    ),
    "random": Part(
        "random mechanisms and a car for every ten, in equal steps and under a tolerance",
        partial(_random, "mechanisms"),
        options=DRAWN,
        words=_said,
    ),
    "machines": Part(
        "random belts, brakes, plays, cams, impacts and stops; rows of several seeds by --from",
        partial(_random, "machines"),
        options=DRAWN,
        pages=("accuracy.md",),
        blocks=random_honesty.random_blocks,
        words=_said,
    ),
}

main = partial(run, "honesty", __doc__, PARTS)

if __name__ == "__main__":
    sys.exit(main())
