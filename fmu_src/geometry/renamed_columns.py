"""Scene of an FMU whose variables have other names than the model, or names and units of another program."""

from collections.abc import Mapping
from typing import Any

from ali3.scene.scene_columns import columns_of
from ali3.scene.scene_parts import frames_of
from fmu_src.variables.variables import Variable

_COLUMNS = ("position", "quaternion", "amplitudes", "angle", "way", "value", "computed", "vector", "tyre", "variables")


def with_renamed_columns(scene: Mapping[str, Any], named: Mapping[str, Variable]) -> dict[str, Any]:
    """The scene with the names of the FMU's variables as its columns.

    `scene`: as `fmu_src.geometry.geometry.geometry` gives it; `named`: variables that have another name, by their names
    in it. A scene is in SI units: what reads one that has another is left out, frames with a word in ``missing``.
    """
    odd = {ours for ours, v in named.items() if v.scale != 1.0}
    frames, missing = dict(scene["frames"]), list(scene["missing"])
    lost = {name for name, frame in frames.items() if odd.intersection(columns_of(frame))}
    while more := {n for n, frame in frames.items() if n not in lost and lost.intersection(frames_of(frame))}:
        lost |= more
    for name in sorted(lost):
        units = ", ".join(f"{named[c].name} in {named[c].unit}" for c in columns_of(frames[name]) if c in odd)
        missing.append({"name": name, "why": f"a scene is in SI units, and the FMU has {units or 'what it stands on'}"})
    kept_frames = {key: _called(part, named) for key, part in frames.items() if key not in lost}
    kept = {
        key: [p for p in scene[key] if not (odd.intersection(columns_of(p)) or lost.intersection(frames_of(p)))]
        for key in ("shapes", "arrows", "flexible")
    } | {"roads": scene["roads"]}
    called = {key: [_called(part, named) for part in parts] for key, parts in kept.items()}
    called["arrows"] = [
        arrow | _slips(ours, named) for arrow, ours in zip(called["arrows"], kept["arrows"], strict=True)
    ]
    called["flexible"] = [part | _gauges(part, named, odd) for part in called["flexible"]]
    focus = "" if scene["focus"] in lost else scene["focus"]
    return {**scene, **called, "frames": kept_frames, "missing": missing, "focus": focus}


def _gauges(part: Mapping[str, Any], named: Mapping[str, Variable], odd: set[str]) -> dict[str, Any]:
    """The gauges of a flexible part with their columns as they are called; SI units only."""
    if "gauges" not in part:
        return {}
    return {"gauges": [_called(gauge, named) for gauge in part["gauges"] if gauge["value"] not in odd]}


def _slips(arrow: Mapping[str, Any], named: Mapping[str, Variable]) -> dict[str, Any]:
    """What of a tyre has another name: its slips and speeds, by which marks, dust and sound go; SI units only."""
    if "tyre" not in arrow:
        return {}
    wheel = arrow["tyre"]["contact"][0].rpartition(".")[0]
    ours = {key: f"{wheel}.{key}" for key in ("slip", "slip_angle", "omega")} | {"speed": "speed"}
    slips = {key: named[name].name for key, name in ours.items() if name in named and named[name].scale == 1.0}
    return {"slips": slips} if slips else {}


def _called(part: Mapping[str, Any], named: Mapping[str, Variable]) -> dict[str, Any]:
    return {key: _name(value, named) if key in _COLUMNS else value for key, value in part.items()}


def _name(value: Any, named: Mapping[str, Variable]) -> Any:
    if isinstance(value, str):
        return named[value].name if value in named else value
    if isinstance(value, Mapping):
        return {key: _name(part, named) for key, part in value.items()}
    return [_name(part, named) for part in value] if isinstance(value, (list, tuple)) else value
