"""Every argument of every method of a model."""

import inspect
from collections.abc import Callable
from dataclasses import is_dataclass
from typing import Any

import numpy as np

from mbs import Model
from mbs.elements import ContactPoints, Drag, EndStops, KerbRoad, PlaneRoad, Wind
from mbs.flexible import InertiaRelief
from mbs.model.body import Body
from mbs.model.joints.joint import Joint
from tests.arguments.wrong_values import Call, kinds_of
from tests.flexible_engine.bodies import bar

BAR = bar((0, 0, 0), (1, 0, 0), dynamic=1)


class Bench:
    """A spatial model with one of each thing."""

    def __init__(self) -> None:
        m = self.m = Model("bench")
        self.arm = m.body("arm", mass=1.0, com=(0.5, 0.0, 0.0), inertia=(0.01, 0.1, 0.1))
        self.box = m.body("box", mass=2.0, com=(1.5, 0.0, 0.0), inertia=(0.1, 0.1, 0.1))
        self.ball = m.point_mass("ball", mass=1.0, position=(0.0, 2.0, 0.0))
        self.beam = m.flexible_body("beam", BAR, origin=(5.0, 0.0, 0.0))
        self.hinge = m.revolute("hinge", m.ground, self.arm, point=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
        self.angle = m.relative_angle("angle", m.ground, self.arm, axis=(0.0, 1.0, 0.0))
        self.other = m.relative_angle("other", self.arm, self.box, axis=(0.0, 1.0, 0.0))
        self.wheel = m.spin(
            "wheel",
            carrier=self.box,
            centre=(1.5, 0.0, 0.0),
            axis=(0.0, 1.0, 0.0),
            mass=1.0,
            spin_inertia=0.1,
            diametral_inertia=0.05,
        )
        self.travel = m.travel("travel")
        self.pedal = m.input("pedal", min=-1.0, max=1.0)
        self.guide = m.guide_input("guide", input=self.pedal, frequency=5.0, unit="m")
        self.road = m.road(KerbRoad(1.0, 0.1))
        self.spring = m.spring_damper("spring", (self.arm, (1.0, 0.0, 0.0)), self.ball, stiffness=10.0)
        self.drive = m.drive("motor", self.other, self.guide)
        self.rod = m.distance("rod", (self.arm, (1.0, 0.0, 0.0)), (self.box, (2.0, 0.5, 0.0)))
        self.limited = m.guide_inputs(
            "limited", inputs=(self.pedal, self.pedal), gains=(1.0, 1.0), limits=(-1.0, 1.0), frequency=5.0, unit="m"
        )
        self.sensor = m.sense_position("place", self.arm)
        self.ported = m.ported(self.box, {"left": (1.5, 1.0, 0.0)})


X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
TRAVEL = np.linspace(-0.1, 0.1, 5)
RELIEF = InertiaRelief(np.zeros((2, 3)), np.zeros((2, 3)), np.zeros((2, 3)), np.zeros((2, 3)), np.zeros((6, 3)))


def between(b: Bench, **more: Any) -> dict[str, Any]:
    return {"name": "new", "body_1": b.arm, "body_2": b.box, **more}


def seen(bench: Bench, /, **more: Any) -> dict[str, Any]:
    return {"name": "new", **more, "unit": "m", "description": "what it is"}


RIGHT: dict[str, Callable[[Bench], dict[str, Any]]] = {  # by method, with a word where there are several
    "body": lambda b: {"name": "new", "mass": 1.0, "com": X, "inertia": (1.0, 1.0, 1.0)},
    "point_mass": lambda b: {"name": "new", "mass": 1.0, "position": X},
    "payload": lambda b: {"name": "new", "body": b.arm, "position": X, "mass": 1.0, "point": b.arm.point(X)},
    "flexible_body": lambda b: {"name": "new", "reduced": BAR, "origin": X, "axes": np.eye(3)},
    "ported": lambda b: {"body": b.arm, "ports": {"left": X}},
    "initial_velocity": lambda b: {"body": b.arm, "linear": X, "angular": Y},
    "initial_rate": lambda b: {"coordinate": b.angle, "rate": 1.0},
    "revolute": lambda b: between(b, point=X, axis=Y),
    "spherical": lambda b: between(b, point=X),
    "universal": lambda b: between(b, point=X, axis_1=Y, axis_2=Z),
    "prismatic": lambda b: between(b, axis=X, point=X),
    "cylindrical": lambda b: between(b, point=X, axis=X),
    "weld": lambda b: between(b),
    "point_on_line": lambda b: {"name": "new", "end_1": (b.arm, X), "end_2": (b.box, X), "axis": X},
    "distance": lambda b: {"name": "new", "end_1": (b.arm, X), "end_2": b.ball, "length": 2.0},
    "drive": lambda b: {"name": "new", "driven": b.angle, "guide": b.guide, "switch": True},
    "pin": lambda b: {"name": "new", "body": b.arm, "point": X, "on": False},
    "rolling": lambda b: {
        "name": "new",
        "wheel": b.box,
        "radius": 0.5,
        "centre": (1.5, 0.0, 0.5),
        "axis": Y,
        "level": 0.0,
    },
    "skate": lambda b: {"name": "new", "body": b.arm, "point": X, "direction": X, "switch": True},
    "gear": lambda b: {"name": "new", "wheel_1": b.angle, "wheel_2": b.other, "ratio": 2.0},
    "rack": lambda b: {
        "name": "new",
        "pinion": b.angle,
        "body": b.arm,
        "carrier": b.box,
        "axis": X,
        "radius": 0.1,
        "point": X,
    },
    "coupled_slides": lambda b: {
        "name": "new",
        "body_1": b.arm,
        "body_2": b.box,
        "carrier_1": b.box,
        "carrier_2": b.m.ground,
        "axis_1": X,
        "axis_2": Y,
        "ratio": 2.0,
    },
    "screw": lambda b: between(b, point=X, axis=X, pitch=0.01),
    "drop_link": lambda b: {
        "name": "new",
        "carrier": b.arm,
        "body": b.box,
        "pivot": X,
        "axis": Y,
        "lever_end": (0.5, 0.0, 0.5),
        "link_end": (0.5, 0.3, 1.5),
    },
    "relative_angle": lambda b: between(b, axis=Y, zero=0.5),
    "shape": lambda b: {
        "body": b.arm,
        "kind": "box",
        "at": X,
        "size": (1.0, 2.0, 3.0),
        "axes": np.eye(3),
        **dict.fromkeys(
            ("axis", "ends", "points", "radius", "thickness", "width", "rim", "wire", "coils", "seat", "file", "scale")
        ),
        "name": "new",
        "color": "#c03020",
        "material": "steel",
        "opacity": 0.5,
    },
    "travel": lambda b: {"name": "new", "unit": "rad", "rate": 1.0},
    "tabled_body": lambda b: {
        "name": "new",
        "base": b.arm,
        "parameters": b.travel,
        "axes": [TRAVEL],
        "places": np.outer(TRAVEL, Z) + X,
        "rotations": np.tile(np.eye(3), (5, 1, 1)),
        "mass": 1.0,
        "com": X,
        "inertia": (1.0, 1.0, 1.0),
    },
    "written_inertia": lambda b: {
        "name": "new",
        "point": b.arm.point(X),
        "axes": [b.arm.vector(axis) for axis in np.eye(3)],
        "mass": 1.0,
        "com": X,
        "inertia": (1.0, 1.0, 1.0),
    },
    "written_axis": lambda b: {"spin": b.wheel, "leaning": 0.1},
    "tabled_number": lambda b: {
        "name": "new",
        "parameters": [b.travel],
        "axes": [TRAVEL],
        "values": TRAVEL**2,
        "unit": "rad",
    },
    "armature": lambda b: {"name": "new", "coordinate": b.angle, "inertia": 1.0, "ratio": 2.0},
    "shaft": lambda b: {"name": "new", "inertia": 1.0},
    "spin": lambda b: {
        "name": "new",
        "carrier": b.arm,
        "centre": X,
        "axis": Y,
        "mass": 1.0,
        "spin_inertia": 1.0,
        "diametral_inertia": 1.0,
        "rolling_radius": 0.5,
    },
    "anti_roll_bar": lambda b: {
        "name": "new",
        "left": b.arm,
        "right": b.box,
        "stiffness": 1.0,
        "stiffness_factor": 1.0,
        "damping": 1.0,
        "carrier": b.m.ground,
        "axis": Y,
        "free_twist": 0.5,
        "mirrored": True,
    },
    "input": lambda b: {
        "name": "new",
        "start": 0.0,
        "min": -1.0,
        "max": 1.0,
        "unit": "N",
        "description": "a force",
        "whole": False,
        "port": True,
    },
    "guide_input": lambda b: {"name": "new", "input": b.pedal, "gain": 1.0, "frequency": 5.0, "unit": "m"},
    "guide_inputs": lambda b: {
        "name": "new",
        "inputs": (b.pedal, b.pedal),
        "gains": (1.0, 2.0),
        "limits": (-1.0, 1.0),
        "frequency": 5.0,
        "unit": "m",
    },
    "guide_time": lambda b: {"name": "new", "motion": ([0.0, 1.0, 2.0], [0.0, 1.0, 1.0]), "unit": "m"},
    "guide_table": lambda b: {
        "name": "new",
        "source": b.guide,
        "table": [[0.0, 0.0], [1.0, 2.0]],
        "slopes": [1.0, 3.0],
        "unit": "m",
    },
    "constant": lambda b: {"name": "new", "value": 1.0, "unit": "m", "description": "a length"},
    "slide": lambda b: {"name": "new", "body": b.arm, "point": X, "direction": X, "guide": b.guide},
    "parameter": lambda b: {
        "name": "new",
        "value": 1.0,
        "min": 0.5,
        "max": 2.0,
        "unit": "N/m",
        "description": "a spring",
        "targets": [(b.spring, "stiffness", 1.0)],
        "tunable": True,
        "works": (0.6, 1.8),
    },
    "spring_damper": lambda b: {
        "name": "new",
        "end_1": (b.arm, X),
        "end_2": b.ball,
        "stiffness": 1.0,
        "damping": 1.0,
        "free_length": 1.0,
        "stops": EndStops(),
    },
    "torsional_spring_damper": lambda b: {
        "name": "new",
        "angle": b.angle,
        "stiffness": 1.0,
        "damping": 1.0,
        "free_angle": 0.5,
    },
    "force": lambda b: {"name": "new", "body": b.arm, "point": X, "inputs": [b.pedal, None, None], "axes": "body"},
    "torque": lambda b: {"name": "new", "body": b.arm, "inputs": [b.pedal, None, None], "axes": "body"},
    "torque_on": lambda b: {"name": "new", "angle": b.angle, "input": b.pedal, "gain": 2.0},
    "lift": lambda b: {
        "name": "new",
        "body": b.arm,
        "point": X,
        "forward": X,
        "up": Y,
        "lift_area": 1.0,
        "air_density": 1.0,
        "wind": Wind(b.pedal.index, b.pedal.index),
    },
    "drag": lambda b: {
        "name": "new",
        "body": b.arm,
        "point": X,
        "drag_area": 1.0,
        "air_density": 1.0,
        "wind": Wind(b.pedal.index, b.pedal.index),
    },
    "road_answer": lambda b: {"name": "new", "friction": 0.5, "near": "place"},
    "road": lambda b: {"road": PlaneRoad(), "file": "road.file"},
    "contact_points": lambda b: {
        "name": "new",
        "body": b.arm,
        "points": [X, Y],
        "road": 0,
        "contact": ContactPoints.for_mass(1.0),
    },
    "contact_point": lambda b: {
        "name": "new",
        "body": b.arm,
        "point": X,
        "road": 0,
        "contact": ContactPoints.for_mass(1.0),
    },
    "sense_position": lambda b: seen(b, body=b.arm, point=X, component="x", axes=b.box, order=1),
    "sense_vector": lambda b: seen(b, vector=b.arm.point(X), axes=[b.arm.vector(X), b.arm.vector(Y)], order=1),
    "sense_vector along": lambda b: seen(b, vector=b.arm.point(X), axes=[b.box.vector(X)], order=2),
    "sense_vector length": lambda b: seen(b, vector=b.arm.point(X), axes=[], order=1),
    "sense_coordinate": lambda b: {**seen(b, coordinate=b.angle, order=1, scale=2.0), "display_unit": "deg"},
    "sense_rotation": lambda b: seen(b, body=b.arm, component="x", order=1),
    "sense_rotation quaternion": lambda b: seen(b, body=b.arm, component="w", order=0),
    "sense_angle": lambda b: seen(b, of=b.arm, kind="roll"),
    "sense_angle of a wheel": lambda b: seen(b, of=b.wheel),
    "sense_angle between": lambda b: seen(b, of=(b.arm.vector(X), b.box.vector(X), b.box.vector(Z))),
    "sense_element": lambda b: seen(b, element=b.spring, output="force", scale=2.0),
    "sense_energy": lambda b: seen(b, kind="total"),
    "sense_energy work": lambda b: seen(b, kind="work", elements=[b.spring]),
    "sense_mass": lambda b: seen(b),
    "sense_quasi_static": lambda b: seen(b, body=b.ported, relief=RELIEF, output=1, origin=X),
    "sense_joint": lambda b: seen(b, joint=b.hinge, component="x", kind="moment", on="first", axes=b.arm, point=X),
    "sense_joint force": lambda b: seen(b, joint=b.hinge, component="x", kind="force", on="first", axes="earth"),
    "sense_rod_force": lambda b: seen(b, rods=[b.rod], body=b.arm, axis=X, scale=2.0),
    "sense_guide": lambda b: seen(b, guide=b.guide, kind="motion", order=1, scale=2.0),
    "sense_guide excess": lambda b: seen(b, guide=b.limited, kind="excess", order=0, scale=2.0),
    "sense_guide force": lambda b: seen(b, guide=b.guide, kind="force", joints=[b.drive], scale=2.0),
    "sense_constant": lambda b: {**seen(b, value=1.0), "whole": True, "computed": False},
    "sense_input": lambda b: seen(b, input=b.pedal, scale=2.0),
    "sense_solver": lambda b: {"name": "new", "kind": "violation", "description": "what it is"},
    "turning": lambda b: {"name": "new", "body": b.arm, "at": X, "axis": Y, "angle": b.angle},
    "sliding": lambda b: {"name": "new", "body": b.arm, "at": X, "direction": Y, "way": "place"},
    "mesh_shape": lambda b: {
        "body": b.arm,
        "positions": [X, Y, Z],
        "triangles": [(0, 1, 2)],
        "name": "new",
        "color": "#c03020",
        "material": "paint",
        "opacity": 0.5,
        "cover": True,
    },
    "notice": lambda b: {"sensor": b.sensor, "text": "The arm is away"},
    "add": lambda b: {"element": Drag(1.0).record("new", b.arm.point(X))},
    "joint_named": lambda b: {"name": "hinge"},
}
REGISTER = {"remember", "unique", "new_coordinate", "drawn", "owned_coordinate", "expression", "expressions", "owned"}
REGISTER |= {"anchor", "anchor_axis", "together", "put_off", "look", "draw_before_change"}
REGISTER |= {"enter", "place_of", "summary"}
"""What the vocabulary itself calls, and what has no arguments."""


def method_of(call: str) -> str:
    """The method of an entry of `CALLS`."""
    return call.split(" ")[0]


def flat(thing: Any) -> Any:
    """What a thing is made of, to be compared."""
    if isinstance(thing, (Body, Joint)):
        return type(thing).__name__, thing.name
    if isinstance(thing, np.ndarray):
        return thing.tobytes()
    if isinstance(thing, (list, tuple)):
        return [flat(part) for part in thing]
    if isinstance(thing, set):
        return thing.copy()
    if isinstance(thing, dict):
        return [(key, flat(value)) for key, value in thing.items()]
    if is_dataclass(thing) and not hasattr(thing, "node_names"):
        return type(thing).__name__, repr(thing)
    return thing if isinstance(thing, (str, int, float, type(None))) else type(thing).__name__


def fingerprint(m: Model) -> Any:
    """All that a call may change; expressions that were asked for stay right whatever else is refused."""
    parts = [m, m.ground, *m.bodies, *m.joints]
    return [{key: flat(value) for key, value in vars(part).items() if key != "_expressions"} for part in parts]


def allowed(method: str, argument: str, label: str, value: Any) -> bool:
    """Whether a value is right for an argument after all."""
    message = ("name", "unit", "description", "display_unit", "text", "file", "near")
    if isinstance(value, str) and argument in message:
        return label == "text" or (label == "empty" and argument not in ("name", "text", "file"))
    if label == "empty" and inspect.signature(getattr(Model, method)).parameters[argument].default == "":
        return True
    return argument in ("min", "max") and method == "input" and label == "inf"


def call_of(call: str) -> Call:
    """The call of an entry of `RIGHT`."""
    method = method_of(call)

    def make() -> tuple[Callable[..., object], dict[str, Any]]:
        bench = Bench()
        return getattr(bench.m, method), RIGHT[call](bench)

    return Call(
        make,
        kinds_of(getattr(Model, method)),
        lambda argument, label, value: allowed(method, argument, label, value),
        lambda function: fingerprint(function.__self__),
    )


CALLS = {call: call_of(call) for call in RIGHT}
