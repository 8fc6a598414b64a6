"""The chart of `benchmarks.real_time`: worst steps against a quarter of the deadline, and how many iterations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from benchmarks.shared.command import pyplot


def chart(rows: Sequence[Mapping[str, Any]]) -> Any:
    """A figure of two rows of panels, a column for each fidelity. `rows`: of `benchmarks.real_time`."""
    plt = pyplot()
    fidelities = sorted({row["fidelity"] for row in rows})
    figure, panels = plt.subplots(
        2, len(fidelities), figsize=(3.2 * len(fidelities) + 1.0, 6.4), sharey="row", squeeze=False
    )
    for column, fidelity in enumerate(fidelities):
        mine = [row for row in rows if row["fidelity"] == fidelity]
        _times(panels[0][column], mine, fidelity)
        _iterations(panels[1][column], mine)
    panels[0][0].set_ylabel("processor time of a step, us")
    panels[1][0].set_ylabel("share of the steps")
    panels[0][-1].legend(fontsize=7)
    panels[1][-1].legend(fontsize=7)
    figure.tight_layout()
    return figure


def _times(axes: Any, rows: Sequence[Mapping[str, Any]], fidelity: int) -> None:
    steps = sorted({row["step_ms"] for row in rows})
    axes.plot(steps, [250.0 * h for h in steps], "k--", lw=1, label="quarter of the deadline")
    for limited, colour in ((False, "tab:red"), (True, "tab:blue")):
        mine = sorted((r for r in rows if (r["limit"] > 0) == limited), key=lambda r: r["step_ms"])
        if not mine:
            continue
        word = "with limit" if limited else "no limit"
        axes.plot(
            [r["step_ms"] for r in mine], [r["replayed_us"] for r in mine], "o-", c=colour, label=f"worst, {word}"
        )
        means = [r["mean_us"] for r in mine]
        axes.plot([r["step_ms"] for r in mine], means, ".:", c=colour, label=f"mean, {word}")
    axes.set(xscale="log", yscale="log", xlabel="step, ms", title=f"fidelity {fidelity}", xticks=steps)
    axes.set_xticklabels([f"{h:g}" for h in steps])
    axes.minorticks_off()
    axes.grid(alpha=0.3)


def _iterations(axes: Any, rows: Sequence[Mapping[str, Any]]) -> None:
    free = [row for row in rows if row["limit"] == 0] or rows
    for row in sorted(free, key=lambda r: r["step_ms"]):
        counts, total = row["histogram"], row["steps"]
        filled = [(k, c / total) for k, c in enumerate(counts) if c > 0]
        axes.plot([k for k, _ in filled], [c for _, c in filled], ".-", lw=1, label=f"{row['step_ms']:g} ms")
    axes.set(yscale="log", xlabel="iterations of a step")
    axes.grid(alpha=0.3)
