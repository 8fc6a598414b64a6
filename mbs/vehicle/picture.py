"""Picture of a car as drawn, from the side and from above, with all points of its file."""

from pathlib import Path

from ali3.chart_description import save_figure
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.checks.places import contact_points
from mbs.vehicle.section import sections_of

COLOURS = {"front": "#1c5fd0", "rear": "#e8590c"}
OTHER_COLOUR, TYRE_WIDTH, ROWS = "#2b8a3e", 0.2, 30
WORDS = ("x, m (ahead)", "y, m (left)", "z, m (up)")
LABEL = {"facecolor": "white", "alpha": 0.7, "linewidth": 0.0, "pad": 0.3}


def named_points(car: CarContent) -> dict[str, tuple[float, ...]]:
    """All points and centres of mass of a car file by key path, m."""
    points: dict[str, tuple[float, ...]] = {
        section.key(field): value
        for section in sections_of(car)
        for field in type(section).model_fields
        if isinstance(value := getattr(section, field), tuple)
        and len(value) == 3
        and (q := section.quantity(field)) is not None
        and q.unit == "m"
    }
    return points | contact_points(car)


def draw_car(car: CarContent, file: Path) -> None:
    """Draw the wheels and the points, with numbers and a list of their names, and each axle enlarged.

    Points of the right side, which are mirrored, have no numbers. `file`: a PNG, or what Matplotlib writes by the
    suffix.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patches import Circle, Rectangle

    points = named_points(car)
    columns = -(-len(points) // ROWS)
    figure = Figure(figsize=(17.0 + 2.4 * columns, 9.0), layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(2, 4, width_ratios=(9.0, 4.0, 4.0, 2.4 * columns))
    views = [  # axes, coordinates, table whose points have numbers, title
        (figure.add_subplot(grid[0, 0]), (0, 2), "", f"{car.name} from the side"),
        (figure.add_subplot(grid[1, 0]), (0, 1), "", f"{car.name} from above"),
    ]
    for k, name in enumerate(car.axles, 1):
        views.append((figure.add_subplot(grid[0, k]), (0, 2), name, f"{name} axle from the side"))
        views.append((figure.add_subplot(grid[1, k]), (1, 2), name, f"{name} axle, left, from ahead"))
    for axes, (i, j), axle_filter, title in views:
        for name, axle in car.axles.items():
            centre, r = axle.wheel.centre, axle.tyre.radius
            half_size = (r, 0.5 * TYRE_WIDTH, r)
            for sign in (1.0, -1.0) if not axle_filter else (1.0,) * (name == axle_filter):
                mid = (centre[0], sign * centre[1], centre[2])
                corner = (mid[i] - half_size[i], mid[j] - half_size[j])
                wheel = (
                    Circle((mid[0], mid[2]), r)
                    if j == 2 and i == 0
                    else Rectangle(corner, 2 * half_size[i], 2 * half_size[j])
                )
                wheel.set(fill=False, edgecolor=COLOURS[name])
                axes.add_patch(wheel)
        for number, (key, point) in enumerate(points.items(), 1):
            owner = key.split(".", 1)[0]
            if axle_filter not in ("", owner):
                continue
            position, colour = (point[i], point[j]), COLOURS.get(owner, OTHER_COLOUR)
            axes.plot(*position, "o", color=colour, markersize=4)
            if axle_filter or owner not in COLOURS:
                axes.annotate(str(number), position, (3.0, 3.0), textcoords="offset points", fontsize=8, bbox=LABEL)
            if not axle_filter and j == 1 and point[1] and (owner in COLOURS or "ground_contact" in key):
                axes.plot(point[0], -point[1], "o", color=colour, markersize=4, fillstyle="none")
        axes.set(aspect="equal", xlabel=WORDS[i], ylabel=WORDS[j], title=title)
        axes.grid(True, alpha=0.3)
        if j == 2:
            axes.axhline(0.0, color="#888888", linewidth=1.0)
    names = figure.add_subplot(grid[:, 3])
    for number, key in enumerate(points, 1):
        column, row = divmod(number - 1, ROWS)
        text_position = (column / columns, 1.0 - (row + 1.0) / (ROWS + 1.0))
        colour = COLOURS.get(key.split(".", 1)[0], OTHER_COLOUR)
        names.text(*text_position, f"{number:2d} {_short(key)}", fontsize=8, color=colour, va="center")
    names.set_axis_off()
    save_figure(figure, file)


def _short(key: str) -> str:
    """Key path without tables that all points have in common."""
    return ".".join(part for part in key.split(".") if part not in ("suspension", "points", "bodies"))
