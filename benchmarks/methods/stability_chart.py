"""Charts of the maps of `benchmarks.stability`: a panel for each method, penalty over step."""

import textwrap
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.lines import Line2D

from benchmarks.shared.command import pyplot, save_chart
from benchmarks.shared.pages import Row

LOOK = {"fine": ("#009E73", "s"), "wrong": ("#E69F00", "v"), "refused": ("#56B4E9", "D"), "diverged": ("#D55E00", "X")}
"""Colour (of Okabe and Ito) and marker by outcome."""


def draw(rows: Sequence[Row], title: str, file: Path) -> None:
    """Draw the maps of a scene; default settings are the marks with a black edge at the bottom."""
    plt = pyplot()
    methods = list(dict.fromkeys(r["method"] for r in rows))
    columns = 5
    lines = -(-len(methods) // columns)
    figure, axes = plt.subplots(lines, columns, figsize=(14.0, 2.9 * lines), squeeze=False, layout="constrained")
    for ax, method in zip(axes.flat, methods, strict=False):
        method_rows = [r for r in rows if r["method"] == method]
        values = sorted(
            {r["value"] for r in method_rows if r["value"] is not None},
            reverse=method_rows[0]["parameter"][:3] == "eps",
        )
        for r in method_rows:
            colour, marker = LOOK[r["outcome"]]
            default = r["value"] is None
            y = -1.5 if default else values.index(r["value"])
            ax.plot(
                np.log10(r["h_s"]),
                y,
                marker,
                color=colour,
                markersize=6,
                markeredgecolor="black" if default else colour,
                linestyle="none",
            )
        ticks = list(range(len(values)))
        ax.set_yticks(([-1.5] if any(r["value"] is None for r in method_rows) else []) + ticks)
        names = [f"{v:.0e}".replace("e+0", "e").replace("e-0", "e-") for v in values]
        ax.set_yticklabels((["default"] if any(r["value"] is None for r in method_rows) else []) + names, fontsize=7)
        ax.set_ylabel(method_rows[0]["parameter"] if values else "no penalty", fontsize=7)
        ax.set_title(textwrap.fill(method, 30), fontsize=8)
        ax.tick_params(axis="x", labelsize=7)
        ax.locator_params(axis="x", nbins=5)
        ax.set_xlabel("log10 of the step, s", fontsize=7)
    for ax in list(axes.flat)[len(methods) :]:
        ax.set_visible(False)
    handles = [Line2D([], [], color=c, marker=m, linestyle="none", label=o) for o, (c, m) in LOOK.items()]
    figure.legend(handles=handles, loc="outside upper right", ncols=4, fontsize=8, frameon=False)
    figure.suptitle(title, fontsize=10, x=0.3)
    save_chart(figure, file)
