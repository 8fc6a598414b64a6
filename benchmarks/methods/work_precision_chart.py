"""Chart of `benchmarks.work_precision`: error over wall time and over factorizations."""

from collections.abc import Sequence
from pathlib import Path

from matplotlib.ticker import NullFormatter

from benchmarks.methods.kernel_methods import TITLES, controlled
from benchmarks.references.cases import Case
from benchmarks.shared.command import pyplot, save_chart
from benchmarks.shared.machine import machine
from benchmarks.shared.pages import Row

KERNEL = {
    TITLES["ali3p"]: ("#0072B2", "o"),
    TITLES["ali3p_generalised_alpha"]: ("#56B4E9", "s"),
    TITLES["energy_momentum"]: ("#D55E00", "D"),
    TITLES["energy_momentum_4"]: ("#E69F00", "^"),
    TITLES["runge_kutta_8"]: ("#000000", "v"),
    TITLES["semi_recursive"]: ("#882255", "P"),
    TITLES["semi_recursive_4"]: ("#CC79A7", "X"),
    TITLES["radau_5"]: ("#009E73", "*"),
}
"""Colour (of Okabe and Ito, one of Tol) and marker of the drawn methods of the kernel, the same in every chart."""
OTHERS = {
    "classical": ("#777777", ":", "osD^vPX"),
    "drake": ("#8b6914", "--", "PX"),
    "exudyn": ("#444444", "--", "os^"),
    "mujoco": ("#999999", "--", "v<"),
    "pinocchio": ("#000000", "--", "dD"),
}
"""Colour, line style, and markers of the methods of each family."""
CONTROLLED = {controlled(title): style for title, style in KERNEL.items()}
"""Colour and marker of runs with a tolerance."""
MAX_ERROR = 0.5  # of a drawn run, relative to the extent of the motion
PANELS = {"wall_s": ("kernel", "drake", "exudyn", "mujoco", "pinocchio"), "factorizations": ("kernel", "classical")}
"""Families in each panel: compiled programs by time, methods that count factorizations."""


def draw(rows: Sequence[Row], case: Case, largest_error: float, file: Path) -> None:
    """Draw errors over wall time of the kernel and other engines, and over factorizations of the kernel and Python
    methods.

    `largest_error`: bound for a drawn run, in the unit of the case; `file`: PNG.
    """
    plt = pyplot()
    figure, axes = plt.subplots(1, 2, figsize=(11.0, 4.6), sharey=True, layout="constrained")
    for ax, (key, families) in zip(axes, PANELS.items(), strict=True):
        for family in families:
            for k, method in enumerate(dict.fromkeys(r["method"] for r in rows if r["family"] == family)):
                points = [
                    (r[key], r["position_error_m"])
                    for r in rows
                    if r["method"] == method and r["wall_s"] and r[key] and r["position_error_m"] < largest_error
                ]
                if not points or (family == "kernel" and method not in KERNEL | CONTROLLED):
                    continue
                colour, line, marks = OTHERS.get(family, ("", "-." if method in CONTROLLED else "-", " "))
                colour, marker = (KERNEL | CONTROLLED).get(method, (colour, marks[k % len(marks)]))
                ax.loglog(
                    *zip(*points, strict=True),
                    line,
                    marker=marker,
                    color=colour,
                    fillstyle="full" if method in KERNEL else "none",
                    linewidth=1.8 if method in KERNEL else 1.1,
                    markersize=5.5,
                    label=method,
                )
        ax.grid(True, which="major", alpha=0.35)
        ax.xaxis.set_minor_formatter(NullFormatter())
    axes[0].set_xlabel(f"wall time of the steps, s ({machine()['processor']})")
    axes[1].set_xlabel("factorizations")
    axes[0].set_ylabel(f"largest error of the output point, {case.unit}")
    handles = {label: handle for ax in axes for handle, label in zip(*ax.get_legend_handles_labels(), strict=True)}
    figure.legend(handles.values(), handles.keys(), loc="outside right center", fontsize=7.5, frameon=False)
    figure.suptitle(
        f"{case.title}   (solid: kernel, C, equal steps; dash-dotted: to a tolerance; dotted: Python; "
        "dashed: other engines, C++)",
        fontsize=10,
    )
    save_chart(figure, file)
