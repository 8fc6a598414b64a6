"""Every number of an element and of a road."""

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np

from mbs import Model, elements
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
TYRE = elements.Tyre(
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
    "AutomaticDrive": (elements.AutomaticDrive(200.0, 1e5), lambda e: e.record("e", SPIN, SPIN, F, G, 0)),
    "BodyForce": (elements.BodyForce([0, None, 1]), lambda e: e.record("e", POINT, FRAME)),
    "BodyTorque": (elements.BodyTorque([0, None, 1]), lambda e: e.record("e", FRAME)),
    "Brake": (elements.Brake(100.0, 1e4, 10.0), lambda e: e.record("e", F, G, SPIN, 0)),
    "ContactPoints": (elements.ContactPoints.for_mass(10.0), lambda e: e.record("e", POINT, FRAME, np.eye(3), 0)),
    "CoordinateFriction": (elements.CoordinateFriction(1.0, 100.0, 1.0), lambda e: e.record("e", SPIN)),
    "Drag": (elements.Drag(0.5), lambda e: e.record("e", POINT)),
    "ElectricDrive": (elements.ElectricDrive(200.0, 1e5, 9.0), lambda e: e.record("e", SPIN, SPIN, F, G, 0, 1)),
    "EndStops": (elements.EndStops(), lambda e: elements.SpringDamper(1.0, stops=e).record("e", POINT)),
    "GyroscopicSpin": (elements.GyroscopicSpin(1.0), lambda e: e.record("e", F, G, SPIN)),
    "HubWrench": (elements.HubWrench([0, 1, 2, 3, 4, 5]), lambda e: e.record("e", POINT, F, SPIN)),
    "InputForce": (elements.InputForce(0, (1.0,)), lambda e: e.record("e", [SPIN])),
    "Lift": (elements.Lift(0.5), lambda e: e.record("e", POINT, F, G)),
    "ScalarSpringDamper": (elements.ScalarSpringDamper(1.0, 1.0, 1.0, 1.0), lambda e: e.record("e", SPIN)),
    "SpinAngle": (elements.SpinAngle(), lambda e: e.record("e", F, G, SPIN)),
    "SpinTorque": (elements.SpinTorque(0, 1.0), lambda e: e.record("e", F, G, SPIN)),
    "SpringDamper": (elements.SpringDamper(1.0, 1.0, 1.0), lambda e: e.record("e", POINT)),
    "TorsionBar": (elements.TorsionBar(100.0, 1.0, 3.0, 50.0), lambda e: e.record("e", SPIN, SPIN)),
    "SpringDamperTable": (
        elements.SpringDamperTable(((-1.0, -2.0), (0.0, 0.0)), 1.0, 1.0),
        lambda e: e.record("e", POINT),
    ),
    "Tyre": (TYRE, lambda e: e.record("e", POINT, F, SPIN, 0)),
    "PlaneRoad": (elements.PlaneRoad(), Model("roads").road),
    "KerbRoad": (elements.KerbRoad(1.0, 0.1), Model("roads").road),
    "PortRoad": (elements.PortRoad([0]), ANSWERED.road),
    "Wind": (elements.Wind(0, 1), lambda e: elements.WindDrag(0.5, wind=e).record("e", POINT)),
    "WindDrag": (elements.WindDrag(0.5, wind=elements.Wind(0, 1)), lambda e: e.record("e", POINT)),
    "GridRoad": (elements.GridRoad((0.0, 0.0), (1.0, 1.0), np.zeros((2, 5)), np.ones((2, 5))), Model("roads").road),
}


def allowed(thing: Any, field: str, label: str, value: Any) -> bool:
    """Whether a value is right after all."""
    if label == "a matrix":
        return isinstance(thing, elements.GridRoad) and field in ("heights", "frictions")
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
