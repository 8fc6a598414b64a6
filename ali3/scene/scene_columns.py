"""Finds the columns that the parts of a scene read, and removes parts whose columns are missing."""

from collections.abc import Callable, Mapping
from typing import Any

from ali3.scene.scene_parts import GROUND, frames_of


def columns_of(part: Mapping[str, Any]) -> list[str]:
    """Columns that a frame, an arrow, a gauge, or a flexible part without its gauges reads."""
    columns = [*part.get("position", ()), *part.get("quaternion", ()), *part.get("amplitudes", ())]
    columns += [part[key] for key in ("angle", "way", "value", "computed") if key in part]
    columns += [name for name in part.get("vector", ()) if name is not None]
    for names in part.get("tyre", {}).values():
        columns += names
    return columns


def pose_columns(scene: Mapping[str, Any]) -> list[str]:
    """Columns that frames and flexible parts read, each once."""
    parts = [*scene["frames"].values(), *(scene.get("flexible") or [])]
    return list(dict.fromkeys(name for part in parts for name in columns_of(part)))


def all_columns(scene: Mapping[str, Any]) -> list[str]:
    """Columns that any part of a scene reads, each once."""
    gauges = [gauge for part in scene.get("flexible") or [] for gauge in part.get("gauges") or []]
    columns = [name for part in (*(scene.get("arrows") or []), *gauges) for name in columns_of(part)]
    return list(dict.fromkeys([*pose_columns(scene), *columns]))


def drawable(scene: Mapping[str, Any], fault: Callable[[str], str | None]) -> tuple[dict[str, Any], dict[str, str]]:
    """A scene without parts whose columns are faulty, and without parts attached to these.

    `fault`: why a column cannot be used, as a predicate; None if it can be used.

    Returns
    -------
    scene : dict
        The remaining scene.
    reasons : dict
        Why a frame, a body, an arrow or a flexible part is not drawn, by its name.
    """
    reasons: dict[str, str] = {}

    def column_fault(part: Mapping[str, Any]) -> str | None:
        return next((reason for name in columns_of(part) if (reason := fault(name)) is not None), None)

    faulty_frames: dict[str, str] = {}
    undecided_frames = dict(scene["frames"])
    while undecided_frames:  # frames that others depend on are decided first
        for name, frame in list(undecided_frames.items()):
            if any(parent in undecided_frames for parent in frames_of(frame)):
                continue
            del undecided_frames[name]
            faulty_parent = next((parent for parent in frames_of(frame) if parent in faulty_frames), None)
            reason = column_fault(frame) or (faulty_frames[faulty_parent] if faulty_parent is not None else None)
            if reason is not None:
                faulty_frames[name] = reason
                reasons[name] = reason

    def is_attached(part: Mapping[str, Any]) -> bool:
        return not any(parent in faulty_frames for parent in frames_of(part))

    drawable_scene: dict[str, Any] = dict(scene)
    drawable_scene["frames"] = {name: frame for name, frame in scene["frames"].items() if name not in faulty_frames}
    drawable_scene["shapes"] = []
    for shape in scene["shapes"]:
        if is_attached(shape):
            drawable_scene["shapes"].append(shape)
            continue
        body = shape.get("body") or shape.get("name")
        if body is not None and body not in reasons:
            reasons[body] = next(faulty_frames[parent] for parent in frames_of(shape) if parent in faulty_frames)
    for key, label in (("flexible", "deformation of"), ("arrows", "arrow")):
        drawable_scene[key] = []
        for part in scene.get(key) or []:
            reason = column_fault(part)
            if reason is None and is_attached(part):
                drawable_scene[key].append(part)
            elif reason is not None:
                reasons[f"{label} {part.get('name') or part.get('frame', '')}"] = reason
    if drawable_scene.get("focus", "") not in ("", GROUND, *drawable_scene["frames"]):
        drawable_scene["focus"] = ""
    return drawable_scene, reasons
