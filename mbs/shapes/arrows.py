"""Arrows of a scene: forces that sensors of the model read."""

from collections.abc import Sequence
from typing import Any

from mbs.common.affine import Affine
from mbs.kernel.header.enumerations import ElementType, SensorType
from mbs.model.model import Model
from mbs.model.sensor import Sensor
from mbs.shapes.frames import FrameNames, place_drawn
from mbs.shapes.joint_points import Line

Arrow = dict[str, Any]
TYRE_OUTPUTS = {
    "contact": [f"contact_{c}" for c in "xyz"],
    "normal": [f"normal_{c}" for c in "xyz"],
    "forces": ["longitudinal_force", "lateral_force", "vertical_force"],
}
"""Outputs of a tyre that its arrow needs, by part of the arrow."""


def force_arrows(model: Model, names: FrameNames, lines: Sequence[Line]) -> list[Arrow]:
    """Arrows of forces that sensors read: of springs and rods along their lines, of tyres, and of joints on their first
    bodies.
    """
    return [*_line_arrows(model, lines), *_tyre_arrows(model), *_joint_arrows(model, names)]


def _tyre_arrows(model: Model) -> list[Arrow]:
    """Arrows of tyres whose contact, forces and axis are all read by sensors."""
    outputs: dict[tuple[int, str], str] = {}
    vectors: dict[tuple[tuple[int, float], ...], str] = {}
    for sensor in model.sensors:
        if sensor.type == SensorType.ELEMENT_OUTPUT and sensor.reals[0] == 1.0:
            element, k = sensor.integers
            outputs.setdefault((element, model.elements[element].outputs[k].name), sensor.name)
        elif sensor.type == SensorType.SIGNAL and list(sensor.reals) == [1.0]:
            vectors.setdefault(_signal_key(sensor.signals[0]), sensor.name)
    arrows = []
    for k, record in enumerate(model.elements):
        if record.type not in (ElementType.TYRE, ElementType.MAGIC_TYRE):
            continue
        sensor_names = {part: [outputs.get((k, name)) for name in names] for part, names in TYRE_OUTPUTS.items()}
        sensor_names["axis"] = [vectors.get(_signal_key(record.signals[3 + i])) for i in range(3)]
        if all(name is not None for names in sensor_names.values() for name in names):
            arrows.append({"name": record.name, "unit": "N", "tyre": sensor_names})
    return arrows


def _signal_key(signal: Affine) -> tuple[tuple[int, float], ...]:
    """Hashable form of an affine expression."""
    return (*sorted(signal.terms.items()), (-1, signal.constant))


def _line_arrows(model: Model, lines: Sequence[Line]) -> list[Arrow]:
    """Arrows of springs and rods whose force a sensor reads; positive values pull the ends together."""
    arrows: dict[str, Arrow] = {}
    by_name = {line.name: line for line in lines}
    for sensor in model.sensors:
        name, tension = _tension(model, sensor)
        if name in by_name and name not in arrows and tension:
            ends = [list(end) for end in by_name[name].ends]
            sign = -1 if tension > 0.0 else 1
            arrows[name] = {"name": name, "unit": "N", "value": sensor.name, "between": ends, "sign": sign}
    return list(arrows.values())


def _tension(model: Model, sensor: Sensor) -> tuple[str, float]:
    """Name of the spring or rod whose force a sensor reads, and the factor from tension to its value; 0: none."""
    if sensor.unit != "N":
        return "", 0.0
    if sensor.type == SensorType.ELEMENT_OUTPUT:
        record = model.elements[sensor.integers[0]]
        return record.name, sensor.reals[0] if record.outputs[sensor.integers[1]].name == "force" else 0.0
    if sensor.type == SensorType.REACTION and sensor.joint is not None and sensor.joint.type == "distance":
        return sensor.joint.name, sensor.reals[0]
    return "", 0.0


def _joint_arrows(model: Model, names: FrameNames) -> list[Arrow]:
    """Arrows of joints of whose force sensors read all components in earth axes."""
    components: dict[str, dict[int, str]] = {}
    joints = {joint.name: joint for joint in model.joints}
    for sensor in model.sensors:
        joint = sensor.joint
        if sensor.type != SensorType.REACTION or joint is None or joint.normals or not joint.rows_weight:
            continue
        rows = joint.force_equations
        if len(rows) == model.dimension and len(sensor.integers) == 1 and sensor.reals[0] == -joint.rows_weight:
            components.setdefault(joint.name, {}).setdefault(rows.index(sensor.integers[0]), sensor.name)
    arrows, drawn = [], model.drawn()
    for name, sensor_names in components.items():
        ends = joints[name].ends
        if len(sensor_names) < model.dimension or ends is None:
            continue
        # the third component of a planar model is the coordinate z, which is 0
        moving = next(b for b in ends.bodies if not b.is_ground)
        vector = [sensor_names.get(k) or names.columns[f"{moving.owner.name}.z"] for k in range(3)]
        at = list(names.anchor(ends.bodies[0], place_drawn(drawn, ends.points[0])))
        arrows.append({"name": name, "unit": "N", "vector": vector, "axes": "ground", "at": at})
    return arrows
