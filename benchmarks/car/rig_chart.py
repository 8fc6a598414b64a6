"""Curves of the axles on the rig, and the hard points of a car, as a picture."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.car.rig import WHEELS, moved
from benchmarks.shared.command import pyplot, save_chart
from mbs.vehicle import Car

COLOURS = ("#1f77b4", "#d62728", "#2ca02c", "#9467bd")


def draw(cars: Mapping[str, Car], file: Path) -> None:
    """Toe and camber over travel, wheel loads over travel, steering in roll; a row per axle."""
    figure, axes = pyplot().subplots(2, 4, figsize=(16, 7.5), layout="constrained")
    for (name, car), colour in zip(cars.items(), COLOURS * len(cars), strict=False):
        heave, roll = moved(car, heave=True), moved(car, roll=True)
        middle = slice(len(heave.t) // 4, -len(heave.t) // 4)
        for row, (axle, (left, right)) in zip(axes, WHEELS.items(), strict=True):
            track = getattr(car, axle).track
            z = 1e3 * heave[f"wheel_{left}.travel"][middle]
            phi = np.degrees(roll[f"wheel_{right}.travel"] - roll[f"wheel_{left}.travel"])[middle] / track
            steer = 0.5 * (roll[f"wheel_{left}.steer"] + roll[f"wheel_{right}.steer"])[middle]
            moment = 0.5e-3 * track * (roll[f"wheel_{right}.Fz"] - roll[f"wheel_{left}.Fz"])[middle]
            style = {"color": colour, "label": name}
            row[0].plot(np.degrees(heave[f"wheel_{left}.steer"])[middle], z, **style)
            row[1].plot(-np.degrees(heave[f"wheel_{left}.inclination"])[middle], z, **style)
            row[2].plot(phi, np.degrees(steer), **style)
            row[3].plot(phi, moment, **style)
    for row, axle in zip(axes, WHEELS, strict=True):
        _labels(row, axle)
    axes[0][0].legend()
    save_chart(figure, file)


def _labels(row: Any, axle: str) -> None:
    for ax, x, y in zip(
        row,
        (
            "steering angle of the left wheel, deg",
            "inclination of the left wheel to the outside, deg",
            *("suspension roll angle, deg",) * 2,
        ),
        (*("travel in bump, mm",) * 2, "mean steering angle, deg", "roll moment of the wheel loads, kN m"),
        strict=True,
    ):
        ax.set_xlabel(x)
        ax.set_ylabel(f"{axle}: {y}")
        ax.grid(alpha=0.3)
