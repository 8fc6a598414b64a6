"""Whether wrong runs warn: ``python -m benchmarks.honesty --family F --random N --seed S``, or ``PART``.

Compares the true error of a run with its estimate by `mbs.simulate`, for coarse and fine steps. A run is wrong when the
error of a compared sensor is more than 5 % of its range at one of 51 instants, or with a tolerance more than ten times
the tolerance. A warning without a wrong run is a false alarm; runs with 4.5 to 5.5 % are not judged. References
are exact motions; for random cases Newton's and Euler's equations solved by DOP853; for cars and flexible bodies two
methods with small steps.
"""

import sys
from argparse import Namespace
from functools import partial
from typing import Any

from ali3.errors import UserError
from benchmarks.methods import honesty, random_honesty
from benchmarks.methods.families import FAMILIES
from benchmarks.methods.honesty_scenes import SCENES
from benchmarks.methods.random_honesty import rows_of
from benchmarks.shared.command import Part, run, watched


def _scenes(options: Namespace) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = []
    for name in watched(list(honesty.QUICK) if options.quick else options.only):
        for method in ["ali3p"] if options.quick else SCENES[name].methods():
            for h in honesty.QUICK[name] if options.quick else SCENES[name].steps:
                rows.append(honesty.measure(name, method, h))
                if rows[-1]["cpu_s"] > honesty.MAX_TIME:
                    break
    return rows


def _random(options: Namespace) -> list[dict[str, Any]]:
    if unknown := sorted({*options.family} - {*FAMILIES}):
        raise UserError(f"There is no family {unknown[0]!r}; there are {', '.join(FAMILIES)}.")
    cases = [(family, number) for family in options.family for number in range(options.random)]
    return [row for family, number in watched(cases) for row in rows_of(family, options.seed, [number])]


PARTS = {
    "random": Part(
        f"cases by chance of families ({', '.join(FAMILIES)}), in equal steps and under a tolerance",
        _random,
        options={
            "family": ([*FAMILIES], "which"),
            "random": (40, "how many are drawn of each"),
            "seed": (1, "of the random numbers"),
        },
        pages=("accuracy.md",),
        blocks=random_honesty.random_blocks,
        words=random_honesty.text_of,
        is_default=True,
    ),
    "scenes": Part(
        "every scene, method and manoeuvre of the prototype",
        _scenes,
        names=tuple(SCENES),
        options={"quick": (False, "three scenes, the default method, a few steps")},
        pages=("accuracy.md",),
        blocks=honesty.honesty_blocks,
    ),
}

main = partial(run, "honesty", __doc__, PARTS)

if __name__ == "__main__":
    sys.exit(main())
