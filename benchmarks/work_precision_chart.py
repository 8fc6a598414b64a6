"""The chart of `benchmarks.work_precision`: error against wall time and against factorizations."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.command import pyplot, save_chart
from benchmarks.common import machine

COLOURS = ("#0072B2", "#56B4E9", "#009E73", "#D55E00", "#CC79A7", "#E69F00", "#000000", "#882255", "#999999", "#44AA99")
"""Okabe and Ito, then wine, grey and teal of Tol."""
MARKERS = "osD^vPX*<>"
LINES = {"kernel": "-", "classical": ":"}
PEERS = "--"


def draw(rows: Sequence[dict[str, Any]], scene: str, title: str, lost: float, file: Path) -> None:
    """Left: wall time; right: factorizations, for the methods that count them. Runs that lost the motion are left out.

    Parameters
    ----------
    rows : sequence of dict
        Of one scene.
    scene, title : str
    lost : float
        Error, m, from which a run has no point.
    file : Path
        PNG.
    """
    plt = pyplot()
    from matplotlib.ticker import NullFormatter

    figure, axes = plt.subplots(1, 2, figsize=(11.0, 4.6), sharey=True, layout="constrained")
    families: dict[str, list[str]] = {}
    for r in rows:
        methods = families.setdefault(r["family"], [])
        if r["method"] not in methods:
            methods.append(r["method"])
    for ax, key in zip(axes, ("wall_s", "factorizations"), strict=True):
        for family, methods in families.items():
            for k, method in enumerate(methods):
                points = [
                    (r[key], r["position_error_m"])
                    for r in rows
                    if r["method"] == method and r["wall_s"] and r[key] and r["position_error_m"] < lost
                ]
                if points:
                    ax.loglog(
                        *zip(*points, strict=True),
                        LINES.get(family, PEERS),
                        marker=MARKERS[k % len(MARKERS)],
                        color=COLOURS[k % len(COLOURS)]
                        if family in LINES
                        else ("#000000", "#999999")[family == "mujoco"],
                        fillstyle="full" if family == "kernel" else "none",
                        linewidth=2.0 if family == "kernel" else 1.2,
                        markersize=5.5,
                        label=method,
                    )
        ax.grid(True, which="major", alpha=0.35)
        ax.xaxis.set_minor_formatter(NullFormatter())
    axes[0].set_xlabel(f"wall time of the steps, s ({machine()['processor']})")
    axes[1].set_xlabel("factorizations")
    axes[0].set_ylabel("largest position error, m")
    handles = {label: handle for ax in axes for handle, label in zip(*ax.get_legend_handles_labels(), strict=True)}
    figure.legend(handles.values(), handles.keys(), loc="outside right center", fontsize=7.5, frameon=False)
    figure.suptitle(f"{title}   (solid: kernel, C; dotted: Python; dashed: other engines)", fontsize=10)
    save_chart(figure, file)
