"""Mechanisms of wheels coupled by gears, racks and screws, without loads: all rates are constant."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

import mbs

INERTIA = 0.02  # kg m2


class FreeModel:
    """A model with sensors and inputs, without gravity or with the gravitational acceleration `weight`, m/s2."""

    def __init__(self, dimension: int = 2, weight: float = 0.0) -> None:
        gravity = (*(0.0,) * (dimension - 1), -weight)
        self.model = mbs.Model("free", dimension=dimension, gravity=gravity)
        self.angles: dict[str, tuple[mbs.Coordinate, float]] = {}
        """Coordinate and rate, rad/s, by name."""
        self.couplings: list[tuple[str, str, float]] = []
        """Two sensors and the ratio of the first to the second."""
        self.inputs: dict[str, Callable[[float], float]] = {}
        """Functions of time, s, by the name of the input."""

    def pedal(self, name: str, size: float, rate: float) -> mbs.Input:
        """Add a sinusoidal input of amplitude `size` and rate, rad/s."""
        self.inputs[name] = lambda t: size * math.sin(rate * t)
        return self.model.input(name)

    def compiled(self) -> mbs.System:
        """The System, with sensors of its bodies, its energy, and the work of elements and driving functions."""
        for body in self.model.bodies:
            self.model.sense_position(f"x of {body.name}", body, None, "x")
            if not body.is_point:
                nodes = body.flexibility.nodes if body.flexibility is not None else [body.com]
                beside = nodes[-1] if len(nodes) > 1 else body.com + 0.1 * np.eye(len(body.com))[-1]
                self.model.sense_position(f"x beside {body.name}", body, beside, "x")
        self.model.sense_energy("energy")
        if self.model.guides:
            self.model.sense_energy("work", "with guides", list(self.model.elements))
        elif self.model.elements:
            self.model.sense_energy("work", "nonconservative", list(self.model.elements))
        return mbs.compile(self.model)

    def wheel(self, name: str, inertia: float, x: float = 0.0, on: mbs.Body | None = None) -> mbs.Body:
        """Add a wheel on a pin at x, m. `inertia`: kg m2."""
        body = self.model.body(name, mass=1.0, com=(x, 0.0), inertia=inertia)
        self.model.revolute(f"pin {name}", on or self.model.ground, body, point=(x, 0.0))
        return body

    def angle(self, name: str, carrier: mbs.Body, body: mbs.Body, rate: float) -> mbs.Coordinate:
        """Add a relative angle with a sensor and its initial rate, rad/s."""
        angle = self.model.relative_angle(name, carrier, body)
        self.add_angle(name, angle, rate)
        return angle

    def add_angle(self, name: str, angle: mbs.Coordinate, rate: float) -> None:
        """Add a sensor of an angle and its initial rate, rad/s."""
        self.model.initial_rate(angle, rate)
        self.model.sense_coordinate(name, angle)
        self.angles[name] = angle, rate

    def gear(self, first: str, second: str, ratio: float) -> None:
        """Add a gear between two angles."""
        self.model.gear(f"{first} {second}", self.angles[first][0], self.angles[second][0], ratio=ratio)
        self.couplings.append((first, second, ratio))

    def add_rack(self, name: str, pinion: mbs.Coordinate, radius: float) -> mbs.Body:
        """Add a rack on the ground along x, with a pinion."""
        body = self.model.body(name, mass=2.0, com=(0.5, -radius), inertia=0.1)
        self.model.prismatic(f"guide {name}", body, self.model.ground, axis=(1.0, 0.0))
        self.model.rack(f"teeth {name}", pinion, body, carrier=self.model.ground, axis=(1.0, 0.0), radius=radius)
        self.model.sense_position(name, body, (0.5, -radius), "x")
        return body


def train(*ratios: float) -> Callable[[float], FreeModel]:
    """Wheels in a row, each with the same energy: the largest error for a pair."""

    def build(rate: float) -> FreeModel:
        w, size = FreeModel(), max(1.0, abs(math.prod(ratios)))
        rates = [rate if abs(math.prod(ratios)) >= 1.0 else rate * abs(math.prod(ratios))]
        rates += [rates[0] / math.prod(ratios[: k + 1]) for k in range(len(ratios))]
        for k, wheel_rate in enumerate(rates):
            body = w.wheel(f"wheel {k}", INERTIA / size * (rate / wheel_rate) ** 2, 0.3 * k)
            w.angle(f"angle {k}", w.model.ground, body, wheel_rate)
        for k, ratio in enumerate(ratios):
            w.gear(f"angle {k}", f"angle {k + 1}", ratio)
        return w

    return build


def rack(rate: float, slides: bool = False) -> FreeModel:
    """A pinion and its rack; `slides`: whether a second slide is coupled to the rack."""
    w = FreeModel()
    pinion = w.angle("pinion", w.model.ground, w.wheel("pinion body", 0.005), rate)
    body = w.add_rack("rack", pinion, 0.05)
    w.couplings.append(("rack", "pinion", 0.05))
    if slides:
        other = w.model.body("other", mass=0.5, com=(0.0, 0.3), inertia=0.1)
        w.model.prismatic("guide", other, w.model.ground, axis=(0.0, 1.0))
        ends: dict[str, Any] = {"carrier_1": w.model.ground, "carrier_2": w.model.ground}
        w.model.coupled_slides("slides", other, body, axis_1=(0.0, 1.0), axis_2=(1.0, 0.0), ratio=-2.0, **ends)
        w.model.sense_position("other", other, None, "y")
        w.couplings.append(("other", "rack", -2.0))
    return w


def screw(rate: float) -> FreeModel:
    """A nut on a screw thread."""
    w, lead = FreeModel(3), 0.1
    nut = w.model.body("nut", mass=2.0, com=(0.0, 0.0, 0.0), inertia=(0.01, 0.01, INERTIA))
    thread = w.model.screw(
        "thread", nut, w.model.ground, point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0), pitch=2.0 * math.pi * lead
    )
    w.model.sense_position("way", nut, None, "z")
    w.add_angle("turn", thread.angle, rate)
    w.couplings.append(("way", "turn", lead))
    return w


def differential(rate: float) -> FreeModel:
    """Two shafts and a carrier on the same axis."""
    w = FreeModel()
    carrier = w.wheel("carrier", 0.1)
    w.angle("carrier angle", w.model.ground, carrier, 0.6 * rate)
    for name, inertia, wheel_rate in (("left", 0.01, 0.4 * rate), ("right", 0.03, -0.4 * rate)):
        w.angle(name, carrier, w.wheel(f"{name} shaft", inertia), wheel_rate)
    w.gear("left", "right", -1.0)
    return w


def planetary(rate: float) -> FreeModel:
    """A sun wheel and a planet on a rotating carrier."""
    w = FreeModel()
    carrier = w.wheel("carrier", 0.1)
    w.angle("carrier angle", w.model.ground, carrier, 0.3 * rate)
    w.angle("planet", carrier, w.wheel("planet body", 0.01, 0.2, carrier), 0.7 * rate)
    w.angle("sun", carrier, w.wheel("sun body", 0.02), -0.35 * rate)
    w.gear("planet", "sun", -2.0)
    return w


def rotor(rate: float) -> FreeModel:
    """A wheel with a rotor behind a gear."""
    w = FreeModel()
    angle = w.angle("angle", w.model.ground, w.wheel("wheel", INERTIA), rate)
    w.model.armature("rotor", angle, inertia=INERTIA / 100.0, ratio=10.0)
    return w


def bevel(rate: float, geared: bool = True) -> FreeModel:
    """A planet with its axis perpendicular to the axis of its carrier, and two shafts that it drives."""
    w, ground = FreeModel(3), (0.0, 0.0, 0.0)
    m, along, across = w.model, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)

    def turning(name: str, on: mbs.Body, axis: tuple[float, ...], inertia: tuple[float, ...]) -> mbs.Body:
        body = m.body(f"{name} body", mass=0.5, com=ground, inertia=inertia)
        m.revolute(f"pin {name}", on, body, point=ground, axis=axis)
        return body

    carrier = turning("carrier", m.ground, along, (0.05, 0.04, 0.045))
    planet = turning("planet", carrier, across, (0.002, 0.003, 0.002))
    w.add_angle("carrier", m.relative_angle("carrier", m.ground, carrier, axis=along), 0.6 * rate)
    w.add_angle("planet", m.relative_angle("planet", carrier, planet, axis=across), 0.8 * rate)
    for name, ratio in (("left", 0.5), ("right", -0.5)) if geared else ():
        shaft = turning(name, m.ground, along, (0.01, 0.008, 0.008))
        w.add_angle(name, m.relative_angle(name, carrier, shaft, axis=along), 0.8 * ratio * rate)
        w.gear(name, "planet", ratio)
    return w


WHEELS: dict[str, Callable[[float], FreeModel]] = {
    "pair, ratio -3": train(-3.0),
    "pair, ratio 10": train(10.0),
    "pair, ratio -0.1": train(-0.1),
    "train, -3 and -2": train(-3.0, -2.0),
    "rack": rack,
    "screw": screw,
    "coupled slides": lambda rate: rack(rate, True),
    "differential": differential,
    "planetary": planetary,
    "armature": rotor,
}
TWO_AXES: dict[str, Callable[[float], FreeModel]] = {
    "bevel differential": bevel,
    "its carrier and planet without gears": lambda rate: bevel(rate, False),
}
"""Mechanisms for which the trapezoidal rule loses energy with and without gears."""


def angle_error_alone(turn: float) -> float:
    """Relative angle error of a wheel alone: the trapezoidal rule rotates it by 2 atan(turn / 2) in a step."""
    return 1.0 - 2.0 * math.atan(0.5 * turn) / turn


def growth(ratio: float, inertia: float, other: float, turn: float, second_turn: float) -> float:
    """Relative energy gain of a pair of wheels in a step of the paper's method, to leading order (docs/theory.md).

    `turn`, `second_turn`: rates of the wheels times the step, rad.
    """
    share = ratio**2 * inertia * other / (ratio**2 * inertia + other) ** 2
    return share * (turn**2 - second_turn**2) ** 2 / 12.0
