"""Picture of the map of a world."""

import math
from pathlib import Path
from typing import Any

import numpy as np

from ali3.chart_description import save_figure
from ali3.scene.base64_numbers import decoded, octets

COLOURS = {
    "asphalt": "#5d6066",
    "concrete": "#b9b5aa",
    "grass": "#8fae6b",
    "gravel": "#b29a74",
    "wet": "#4f7fb5",
    "ice": "#cfe8f5",
    "paint": "#f2f2f2",
    "dirt": "#8a6d4d",
}
CONES = {"orange": "#e8590c", "yellow": "#f2c200", "blue": "#1c5fd0"}


def draw_map(record: dict[str, Any], file: Path) -> None:
    """Draw a world from above, x to the right and y up, with its scenery and start positions.

    `record`: content of the JSON file of the world; `file`: PNG, or another format of Matplotlib by the suffix.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.colors import LightSource, to_rgb
    from matplotlib.figure import Figure

    x0, y0, x1, y1 = record["bounds"]
    width = 14.0
    figure = Figure(figsize=(width, max(4.0, min(14.0, width * (y1 - y0) / (x1 - x0)))), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    for road in record["roads"]:
        if road["kind"] == "terrain":
            surface = road["surface"]
            classes = octets(surface["classes"]).reshape(surface["shape"])
            colours = np.array([to_rgb(COLOURS[name]) for name in surface["names"]])
            heights = _patch_heights(road, record["bounds"])
            shade = LightSource(315.0, 45.0).hillshade(heights.T, vert_exag=3.0)
            rows = np.linspace(0, heights.shape[0] - 1, classes.shape[0]).round().astype(int)
            columns = np.linspace(0, heights.shape[1] - 1, classes.shape[1]).round().astype(int)
            light = 0.6 + 0.6 * shade.T[np.ix_(rows, columns)]
            image = np.clip(colours[classes] * light[:, :, None], 0.0, 1.0)
            axes.imshow(image.transpose(1, 0, 2), origin="lower", extent=(x0, x1, y0, y1), interpolation="antialiased")
    for item in record["scenery"]:
        _draw_object(axes, item)
    for place in record["places"]:
        axes.annotate(
            "",
            (place["x"] + 14.0 * math.cos(place["yaw"]), place["y"] + 14.0 * math.sin(place["yaw"])),
            (place["x"], place["y"]),
            arrowprops={"arrowstyle": "-|>", "color": "#b00020"},
        )
        axes.text(place["x"], place["y"] + 4.0, place["name"], fontsize=7, color="#b00020", clip_on=True)
    axes.set_xlim(x0, x1)
    axes.set_ylim(y0, y1)
    axes.set_aspect("equal")
    axes.set_xlabel("x, m")
    axes.set_ylabel("y, m")
    axes.set_title(f"{record['name']}: surfaces, scenery and the places where a car may start")
    save_figure(figure, file)


def _patch_heights(road: dict[str, Any], bounds: list[float]) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Heights at points about 2 m apart from the patches, m."""
    x0, y0, x1, y1 = bounds
    n = [max(2, math.ceil(side / 2.0)) for side in (x1 - x0, y1 - y0)]
    heights = np.zeros(n)
    step = [(x1 - x0) / n[0], (y1 - y0) / n[1]]
    for patch in road["patches"]:
        z = decoded(patch["heights"], "f").reshape(patch["shape"])
        corner = [(patch["origin"][k] - bounds[k]) / step[k] for k in range(2)]
        size = [patch["spacing"][k] * (patch["shape"][k] - 1) / step[k] for k in range(2)]
        ranges = [
            np.arange(max(0, math.ceil(corner[k] - 0.5)), min(n[k], math.ceil(corner[k] + size[k] - 0.5)))
            for k in range(2)
        ]
        if min(map(len, ranges)) == 0:
            continue
        index = [
            np.clip(((ranges[k] + 0.5 - corner[k]) / size[k] * (patch["shape"][k] - 1)).round().astype(int), 0, 16)
            for k in range(2)
        ]
        heights[np.ix_(*ranges)] = z[np.ix_(*index)]
    return heights


def _draw_object(axes: Any, entry: dict[str, Any]) -> None:
    """Draw an object of the scenery."""
    kind = entry["kind"]
    if kind in ("line", "barrier"):
        points = np.array(entry["points"])
        colour = "#666666" if kind == "barrier" else entry.get("colour", "white")
        style = "--" if "dash" in entry else "-"
        axes.plot(points[:, 0], points[:, 1], style, color=colour, linewidth=1.2 if kind == "barrier" else 0.6)
        return
    x, y, _ = entry["at"]
    if kind == "cone":
        axes.plot(x, y, "^", color=CONES[entry["colour"]], markersize=2.5)
    elif kind == "tree":
        axes.plot(x, y, "o", color="#3f6b35", markersize=0.35 * entry["height"], alpha=0.8)
    elif kind == "building":
        c, s = math.cos(entry["yaw"]), math.sin(entry["yaw"])
        a, b = 0.5 * entry["size"][0], 0.5 * entry["size"][1]
        corners = [(x + c * u - s * v, y + s * u + c * v) for u, v in ((a, b), (-a, b), (-a, -b), (a, -b))]
        axes.fill(*zip(*corners, strict=True), color="#8c5a4a")
    elif kind == "sign":
        axes.text(
            x,
            y,
            entry["text"],
            fontsize=5,
            color="black",
            ha="center",
            va="center",
            clip_on=True,
            bbox={"facecolor": "white", "linewidth": 0.3, "pad": 0.8},
        )
