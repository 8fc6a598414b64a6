"""Every number of an element and of a road."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np

from mbs import Model
from mbs.elements import (
    AutomaticDrive,
    BodyForce,
    BodyTorque,
    Brake,
    ContactPoints,
    CoordinateFriction,
    Drag,
    ElectricDrive,
    EndStops,
    GridRoad,
    GyroscopicSpin,
    HubWrench,
    InputForce,
    KerbRoad,
    Lift,
    PlaneRoad,
    PortRoad,
    ScalarSpringDamper,
    SpinAngle,
    SpinTorque,
    SpringDamper,
    SpringDamperTable,
    TorsionBar,
    Tyre,
    Wind,
    WindDrag,
)
from mbs.vehicle import load
from tests.arguments.wrong_values import Call

CURVES = load("prototype").front.tyre.tyre()

M = Model("bench")
BODY = M.body("body", mass=1.0, com=(0.0, 0.0, 0.0), inertia=(1.0, 1.0, 1.0))
POINT, F, G, SPIN = (
    BODY.point((1.0, 0.0, 0.0)),
    BODY.vector((1.0, 0.0, 0.0)),
    BODY.vector((0.0, 0.0, 1.0)),
    BODY.point((0.0, 0.0, 0.0))[0],
)
FRAME = [BODY.vector(e) for e in np.eye(3)]
TYRE = Tyre(
    radius=0.27,
    bottoming_radius=0.18,
    stiffness=1e5,
    damping=100.0,
    longitudinal=CURVES.longitudinal,
    lateral=CURVES.lateral,
    trail=(0.17, 0.18),
    trail_zero=(0.2, 0.22),
    trail_end=(0.35, 0.4),
    carcass_stiffness=(1e5, 1e5),
    carcass_damping=(100.0, 100.0),
    nominal_load=1500.0,
    reference_friction=1.0,
)

ANSWERED = Model("answered")
ANSWERED.road_answer("road")

USES: dict[str, tuple[Any, Callable[[Any], Any]]] = {
    "AutomaticDrive": (AutomaticDrive(200.0, 1e5), lambda e: e.record("e", SPIN, SPIN, F, G, 0)),
    "BodyForce": (BodyForce([0, None, 1]), lambda e: e.record("e", POINT, FRAME)),
    "BodyTorque": (BodyTorque([0, None, 1]), lambda e: e.record("e", FRAME)),
    "Brake": (Brake(100.0, 1e4, 10.0), lambda e: e.record("e", F, G, SPIN, 0)),
    "ContactPoints": (ContactPoints.for_mass(10.0), lambda e: e.record("e", POINT, FRAME, np.eye(3), 0)),
    "CoordinateFriction": (CoordinateFriction(1.0, 100.0, 1.0), lambda e: e.record("e", SPIN)),
    "Drag": (Drag(0.5), lambda e: e.record("e", POINT)),
    "ElectricDrive": (ElectricDrive(200.0, 1e5, 9.0), lambda e: e.record("e", SPIN, SPIN, F, G, 0, 1)),
    "EndStops": (EndStops(), lambda e: SpringDamper(1.0, stops=e).record("e", POINT)),
    "GyroscopicSpin": (GyroscopicSpin(1.0), lambda e: e.record("e", F, G, SPIN)),
    "HubWrench": (HubWrench([0, 1, 2, 3, 4, 5]), lambda e: e.record("e", POINT, F, SPIN)),
    "InputForce": (InputForce(0, (1.0,)), lambda e: e.record("e", [SPIN])),
    "Lift": (Lift(0.5), lambda e: e.record("e", POINT, F, G)),
    "ScalarSpringDamper": (ScalarSpringDamper(1.0, 1.0, 1.0, 1.0), lambda e: e.record("e", SPIN)),
    "SpinAngle": (SpinAngle(), lambda e: e.record("e", F, G, SPIN)),
    "SpinTorque": (SpinTorque(0, 1.0), lambda e: e.record("e", F, G, SPIN)),
    "SpringDamper": (SpringDamper(1.0, 1.0, 1.0), lambda e: e.record("e", POINT)),
    "TorsionBar": (TorsionBar(100.0, 1.0, 3.0, 50.0), lambda e: e.record("e", SPIN, SPIN)),
    "SpringDamperTable": (
        SpringDamperTable(((-1.0, -2.0), (0.0, 0.0)), 1.0, 1.0),
        lambda e: e.record("e", POINT),
    ),
    "Tyre": (TYRE, lambda e: e.record("e", POINT, F, SPIN, 0)),
    "PlaneRoad": (PlaneRoad(), Model("roads").road),
    "KerbRoad": (KerbRoad(1.0, 0.1), Model("roads").road),
    "PortRoad": (PortRoad([0]), ANSWERED.road),
    "Wind": (Wind(0, 1), lambda e: WindDrag(0.5, wind=e).record("e", POINT)),
    "WindDrag": (WindDrag(0.5, wind=Wind(0, 1)), lambda e: e.record("e", POINT)),
    "GridRoad": (GridRoad((0.0, 0.0), (1.0, 1.0), np.zeros((2, 5)), np.ones((2, 5))), Model("roads").road),
}


def allowed(thing: Any, field: str, label: str, value: Any) -> bool:
    """Whether a value is right after all."""
    if label == "a matrix":
        return isinstance(thing, GridRoad) and field in ("heights", "frictions")
    return field == "unit" and label in ("text", "empty")


def call_of(thing: Any, use: Callable[[Any], Any]) -> Call:
    """The use of a thing, by its fields."""
    fields = dataclasses.fields(thing)
    return Call(
        lambda: (
            lambda **given: use(dataclasses.replace(thing, **given)),
            {field.name: getattr(thing, field.name) for field in fields},
        ),
        {field.name: str(field.type) for field in fields},
        lambda field, label, value: allowed(thing, field, label, value),
    )


CALLS = {name: call_of(*use) for name, use in USES.items()}
