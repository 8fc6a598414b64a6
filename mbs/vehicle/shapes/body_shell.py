"""Drawn body of a car without a tubular frame: a surface lofted over its wheels, from length, width, height and axles.

Its outline is a hatchback, a van if the car is high for its length, or a mean of both. The
proportions belong to no particular car; nothing here enters the simulation.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from mbs.vehicle.car_content import CarContent
from mbs.vehicle.checks.places import contact_points
from mbs.vehicle.shapes.appearance import BODY_PAINT, DARK_PLASTIC, SILL_HEIGHT, Looks, Paint
from mbs.vehicle.shapes.loft import interpolate_columns, loft
from mbs.vehicle.shapes.occupants import steering_wheel_place

GLASS: Paint = {"material": "glass", "color": "#18212b", "opacity": 0.55}
GREY_PLASTIC: Paint = {"material": "plastic", "color": "#565c65"}
LAMP_PAINT: Paint = {"material": "plastic", "color": "#eef4ff"}
TAIL_LAMP_PAINT: Paint = {"material": "plastic", "color": "#a3101c"}
Detail: TypeAlias = "tuple[float, float, float, tuple[float, float, float], Paint]"
"""Positions relative to the length, half width and height; size, m; paint."""
LAMPS: tuple[Detail, ...] = (
    (0.987, 0.56, 0.335, (0.10, 0.28, 0.09), LAMP_PAINT),
    (0.012, 0.70, 0.53, (0.06, 0.22, 0.16), TAIL_LAMP_PAINT),
)
GRILLE: tuple[Detail, ...] = ((0.993, 0.30, 0.235, (0.08, 0.50, 0.10), DARK_PLASTIC),)


class Outline(NamedTuple):
    """Side view of a body: positions from the rear end relative to the length, heights relative to the height of the
    car, half widths relative to the largest."""

    deck: NDArray[np.float64]  # rows of position, height, half width of the lower body
    roof: NDArray[np.float64]  # the same of the roof, from the rear window to the lower edge of the windscreen
    panel: NDArray[np.float64]  # positions of the ends of the roof panel
    details: NDArray[np.float64]  # position of the pillar between the side windows; position and height of the mirrors


HATCHBACK = Outline(
    np.array(
        [
            [0.0, 0.01, 0.035, 0.12, 0.3, 0.62, 0.73, 0.88, 0.96, 0.99, 1.0],
            [0.5, 0.56, 0.63, 0.64, 0.64, 0.625, 0.62, 0.535, 0.455, 0.395, 0.33],
            [0.82, 0.88, 0.93, 0.97, 1.0, 1.0, 0.99, 0.96, 0.87, 0.76, 0.68],
        ]
    ).T,
    np.array(
        [
            [0.03, 0.06, 0.12, 0.18, 0.43, 0.55, 0.64, 0.735],
            [0.62, 0.76, 0.925, 0.957, 1.0, 0.975, 0.83, 0.612],
            [0.8, 0.76, 0.7, 0.68, 0.68, 0.69, 0.75, 0.84],
        ]
    ).T,
    np.array([0.115, 0.565]),
    np.array([0.36, 0.660, 0.66]),
)
VAN = Outline(
    np.array(
        [
            [0.0, 0.006, 0.015, 0.1, 0.3, 0.7, 0.87, 0.94, 0.975, 0.993, 1.0],
            [0.46, 0.5, 0.515, 0.525, 0.525, 0.52, 0.515, 0.49, 0.43, 0.36, 0.3],
            [0.9, 0.94, 0.97, 1.0, 1.0, 1.0, 0.98, 0.95, 0.91, 0.86, 0.82],
        ]
    ).T,
    np.array(
        [
            [0.01, 0.02, 0.036, 0.06, 0.4, 0.75, 0.85, 0.945],
            [0.515, 0.56, 0.88, 0.965, 1.0, 0.975, 0.8, 0.485],
            [0.93, 0.92, 0.85, 0.84, 0.84, 0.84, 0.86, 0.91],
        ]
    ).T,
    np.array([0.045, 0.765]),
    np.array([0.40, 0.885, 0.57]),
)
ARCH_CLEARANCE = 0.055  # m between tyre and arch
CABIN_CLEARANCE = 0.02  # m between an arch and the opening over the cabin
DASHBOARD = 0.13, 0.42  # m: distance ahead of the middle of the steering wheel, and largest thickness
CABIN_INDEX = 6  # index of the first point of a cross-section of the lower body above the cabin
FRONT_OVERHANG = 0.53  # fraction of both overhangs
HEIGHT_OVER_LENGTH = 0.36  # assumed, if HEIGHT_OVER_TYRE gives a higher car
HEIGHT_OVER_TYRE = 4.4  # assumed height, relative to the radius of a front tyre
MASS_HEIGHT = 0.39  # height of the centre of mass, relative to the height of the car, if this gives a higher car
HATCHBACK_RATIO = 0.385  # height / length up to which the body is a hatchback
VAN_RATIO = 0.42  # height / length from which the body is a van


@dataclass(frozen=True)
class BodyShell:
    """Surfaces of the drawn body of a car, in its drawing axes."""

    car: CarContent

    @property
    def height(self) -> float:
        """Height of the roof, m: of the highest ground contact point if it is on the roof, otherwise estimated."""
        contact = self.car.chassis.ground_contact
        radius = 0.0 if contact is None else contact.radius
        highest = max((z + radius for _, _, z in contact_points(self.car).values()), default=0.0)
        estimate = min(HEIGHT_OVER_LENGTH * self.car.vehicle.length, HEIGHT_OVER_TYRE * self.car.front.tyre.radius)
        estimate = max(estimate, self.car.vehicle.reference_point[2] / MASS_HEIGHT)
        return highest if highest > 0.25 * self.car.vehicle.length else estimate

    @cached_property
    def outline(self) -> Outline:
        """Outline between hatchback and van, by the ratio of height to length."""
        ratio = self.height / self.car.vehicle.length
        fraction = min(max((ratio - HATCHBACK_RATIO) / (VAN_RATIO - HATCHBACK_RATIO), 0.0), 1.0)
        return Outline(
            *((1.0 - fraction) * hatchback + fraction * van for hatchback, van in zip(HATCHBACK, VAN, strict=True))
        )

    @property
    def windscreen(self) -> float:
        """Position of the lower edge of the windscreen, relative to the length."""
        return float(self.outline.roof[-1, 0])

    @property
    def rear_end(self) -> float:
        """x of the rear end of the car, m."""
        car = self.car
        overhangs = car.vehicle.length - car.wheelbase
        return car.rear.wheel.centre[0] - (1.0 - FRONT_OVERHANG) * overhangs

    def x_position(self, fraction: float | NDArray[np.float64]) -> NDArray[np.float64]:
        """x at a position relative to the length, from the rear end, m."""
        return np.asarray(self.rear_end + fraction * self.car.vehicle.length)

    def fraction(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Position relative to the length, from the rear end, of x in m."""
        return np.asarray((x - self.rear_end) / self.car.vehicle.length)

    def deck(self, x: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Height and half width of the lower body, m."""
        height, width = interpolate_columns(self.outline.deck, self.fraction(x)).T
        return height * self.height, 0.5 * width * self.car.vehicle.width

    def roof(self, x: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Height and half width of the roof, m."""
        height, width = interpolate_columns(self.outline.roof, self.fraction(x)).T
        return height * self.height, 0.5 * width * self.car.vehicle.width

    def sill(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Height of sills and bumpers, m."""
        sill, fraction = SILL_HEIGHT * self.car.front.tyre.radius, self.fraction(x)
        end_rise = 0.10 * np.clip((0.06 - fraction) / 0.06, 0.0, 1.0) + 0.04 * np.clip(
            (fraction - 0.95) / 0.05, 0.0, 1.0
        )
        return np.asarray(sill + end_rise)

    def lower_edge(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Height of sills, bumpers and arches, m."""
        edge = self.sill(x)
        for axle in (self.car.front, self.car.rear):
            cx, _, cz = axle.wheel.centre
            squared_height = (axle.tyre.radius + ARCH_CLEARANCE) ** 2 - (x - cx) ** 2
            edge = np.where(squared_height > 0.0, np.maximum(edge, cz + np.sqrt(np.maximum(squared_height, 0.0))), edge)
        return np.asarray(edge)

    def stations(self) -> NDArray[np.float64]:
        """x of the cross-sections, m, ascending: dense along the arches."""
        fractions = np.concatenate([np.linspace(0.0, 1.0, 29), [0.005, 0.015, 0.985, 0.995]])
        positions = [self.x_position(fractions), np.array(self.cabin)]
        for axle in (self.car.front, self.car.rear):
            radius = axle.tyre.radius + ARCH_CLEARANCE
            positions.append(axle.wheel.centre[0] + radius * np.cos(np.linspace(0.0, np.pi, 17)))
            positions.append(axle.wheel.centre[0] + radius * np.array([-1.002, 1.002]))
        return np.unique(np.concatenate(positions))

    @property
    def cabin(self) -> tuple[float, float]:
        """x of both ends of the opening over the cabin, m: from the arch of the rear wheels to the windscreen."""
        rear = self.car.rear
        return rear.wheel.centre[0] + rear.tyre.radius + ARCH_CLEARANCE + CABIN_CLEARANCE, float(
            self.x_position(self.windscreen)
        ) - CABIN_CLEARANCE

    def lower_body(self) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Mesh of wheel houses, sides, bonnet and tail, open over the cabin: vertices, m, and triangles.

        The wheel houses reach inwards to the steered tyres.
        """
        x, inner = self.stations(), min(a.wheel.centre[1] - a.tyre.radius for a in (self.car.front, self.car.rear))
        (deck, half), low, sill = self.deck(x), self.lower_edge(x), self.sill(x)
        top = np.maximum(deck, low + 0.02)  # over a wheel that is higher than the bonnet
        rise = top - low
        points, triangles = loft(
            [
                np.array(
                    [
                        (x[k], inner, sill[k]),
                        (x[k], inner, low[k]),
                        (x[k], 0.94 * half[k], low[k]),
                        (x[k], half[k], low[k] + 0.35 * rise[k]),
                        (x[k], half[k], low[k] + 0.62 * rise[k]),
                        (x[k], 0.975 * half[k], low[k] + 0.86 * rise[k]),
                        (x[k], 0.91 * half[k], top[k]),
                        (x[k], 0.55 * half[k], top[k] + 0.015),
                        (x[k], 0.0, top[k] + 0.022),
                    ]
                )
                for k in range(len(x))
            ],
            ends=True,
        )
        ring = 17  # points of a cross-section, both sides; the points of the caps come last
        rear, front = self.cabin
        point, x_of_corner = triangles % ring, points[triangles, 0]
        in_cabin = (
            (point >= CABIN_INDEX) & (point < ring - CABIN_INDEX) & (x_of_corner >= rear) & (x_of_corner <= front)
        )
        return points, triangles[~in_cabin.all(axis=1)]

    def dashboard(self, rear_x: float) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Middle and size of a box from x = `rear_x` to the windscreen, above the wheel houses, m."""
        x = np.linspace(rear_x, float(self.x_position(self.windscreen)), 9)
        top, half = (float(value.min()) for value in self.deck(x))
        low = min(max(top + 0.012 - DASHBOARD[1], float(self.lower_edge(x).max())), top - 0.03)
        middle = 0.5 * (rear_x + x[-1]), 0.0, 0.5 * (low + top + 0.012)
        return middle, (x[-1] - rear_x, 1.84 * half, top + 0.012 - low)

    def window_edges(self, fraction: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lower and upper edge of the left side windows: arrays of shape (n, 3), m."""
        x = self.x_position(fraction)
        top, half = self.deck(x)
        roof, roof_half = self.roof(x)
        lower = np.column_stack([x, 0.90 * half, top - 0.01])
        fraction_up = np.clip((roof - 0.045 - lower[:, 2]) / np.maximum(self.height - lower[:, 2], 1e-6), 0.0, 1.0)
        y = lower[:, 1] + (roof_half - lower[:, 1]) * np.maximum(fraction_up, 0.0)
        return lower, np.column_stack([x, y, np.maximum(roof - 0.045, lower[:, 2])])

    def windows(self) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Mesh of the surface between lower body and roof: vertices, m, and triangles."""
        fraction = np.linspace(self.outline.roof[0, 0], self.windscreen, 25)
        return loft(self._upper_sections(fraction, 0.0))

    def panel(self) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Mesh of the roof panel: vertices, m, and triangles."""
        fraction = np.linspace(self.outline.panel[0], self.outline.panel[1], 15)
        return loft([section[1:] for section in self._upper_sections(fraction, 0.006)])

    def _upper_sections(self, fraction: NDArray[np.float64], lift: float) -> list[NDArray[np.float64]]:
        """Cross-sections of the left half above the lower body, m, with the roof raised by `lift`, m."""
        lower, upper = self.window_edges(fraction)
        height = np.maximum(self.roof(lower[:, 0])[0], lower[:, 2] + 0.004)
        sections = []
        for low, up, top in zip(lower, upper, height, strict=True):
            outer = up + np.array([0.0, lift, 0.5 * lift])
            inner = up[0], 0.82 * up[1], top + lift
            sections.append(np.array([low, outer, inner, (up[0], 0.0, top + lift + 0.012)]))
        return sections


def body_shell_shapes(looks: Looks, *, clear: bool) -> None:
    """Draw the body. `clear`: whether the page can make it transparent and show the frame inside."""
    car, chassis, m = looks.car, looks.chassis, looks.m
    shell = BodyShell(car)
    m.mesh_shape(chassis, *shell.lower_body(), name="body", cover=clear, **BODY_PAINT)
    m.mesh_shape(chassis, *shell.windows(), name="windows", cover=clear, **GLASS)
    m.mesh_shape(chassis, *shell.panel(), name="roof", cover=clear, **BODY_PAINT)
    half_width = 0.5 * car.vehicle.width
    x0, x1 = (float(shell.x_position(fraction)) for fraction in (0.03, 0.96))
    floor = SILL_HEIGHT * car.front.tyre.radius + 0.03
    looks.shape(
        chassis, "box", at=(0.5 * (x0 + x1), 0.0, floor), size=(x1 - x0, 1.05 * half_width, 0.05), **DARK_PLASTIC
    )
    dash, size = shell.dashboard(steering_wheel_place(car)[0] + DASHBOARD[0])
    looks.shape(chassis, "box", at=dash, size=size, **GREY_PLASTIC)
    pillar, mirror_position, height = shell.outline.details.tolist()
    panel, rear = shell.outline.panel.tolist(), float(shell.outline.roof[0, 0])
    lower, upper = shell.window_edges(
        np.concatenate([np.linspace(panel[1], shell.windscreen, 7), [pillar], np.linspace(rear + 0.01, panel[0], 7)])
    )
    rail = shell.window_edges(np.linspace(panel[0], panel[1], 9))[1]
    for side in (1.0, -1.0):
        mirror = np.array([1.0, side, 1.0])
        lines = [upper[:7] * mirror, np.array([lower[7], upper[7]]) * mirror, upper[8:] * mirror, rail * mirror]
        for line in lines:
            looks.tube(*((chassis, point) for point in line), radius=0.019 / looks.scale, **BODY_PAINT)
        _draw_details(
            looks, shell, side, (*LAMPS, *GRILLE, (mirror_position, 1.06, height, (0.10, 0.16, 0.10), BODY_PAINT))
        )


def _draw_details(looks: Looks, shell: BodyShell, side: float, details: Sequence[Detail]) -> None:
    """Draw lamps, grille and mirror on one side of the car as boxes. `side`: 1 left, -1 right."""
    chassis, half = looks.chassis, 0.5 * looks.car.vehicle.width
    for fraction, across, height, size, paint in details:
        position = float(shell.x_position(fraction)), side * across * half, height * shell.height
        looks.shape(chassis, "box", at=position, size=size, **paint)
