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
    in it. A scene is in SI units: parts that read a variable in another unit are left out, frames with an entry in
    ``missing``.
    """
    scaled = {ours for ours, v in named.items() if v.scale != 1.0}
    frames, missing = dict(scene["frames"]), list(scene["missing"])
    lost_frames = {name for name, frame in frames.items() if scaled.intersection(columns_of(frame))}
    while dependent_frames := {
        n for n, frame in frames.items() if n not in lost_frames and lost_frames.intersection(frames_of(frame))
    }:
        lost_frames |= dependent_frames
    for name in sorted(lost_frames):
        units = ", ".join(f"{named[c].name} in {named[c].unit}" for c in columns_of(frames[name]) if c in scaled)
        missing.append({"name": name, "why": f"a scene is in SI units, and the FMU has {units or 'what it stands on'}"})
    kept_frames = {key: _with_columns(part, named) for key, part in frames.items() if key not in lost_frames}
    kept_parts = {
        key: [
            p for p in scene[key] if not (scaled.intersection(columns_of(p)) or lost_frames.intersection(frames_of(p)))
        ]
        for key in ("shapes", "arrows", "flexible")
    } | {"roads": scene["roads"]}
    renamed = {key: [_with_columns(part, named) for part in parts] for key, parts in kept_parts.items()}
    renamed["arrows"] = [
        arrow | _renamed_slips(ours, named) for arrow, ours in zip(renamed["arrows"], kept_parts["arrows"], strict=True)
    ]
    renamed["flexible"] = [part | _renamed_gauges(part, named, scaled) for part in renamed["flexible"]]
    focus = "" if scene["focus"] in lost_frames else scene["focus"]
    return {**scene, **renamed, "frames": kept_frames, "missing": missing, "focus": focus}


def _renamed_gauges(part: Mapping[str, Any], named: Mapping[str, Variable], scaled: set[str]) -> dict[str, Any]:
    """The gauges of a flexible part with renamed columns, those in SI units only."""
    if "gauges" not in part:
        return {}
    return {"gauges": [_with_columns(gauge, named) for gauge in part["gauges"] if gauge["value"] not in scaled]}


def _renamed_slips(arrow: Mapping[str, Any], named: Mapping[str, Variable]) -> dict[str, Any]:
    """Renamed slips and speeds of a tyre, for its marks, dust and sound; those in SI units only."""
    if "tyre" not in arrow:
        return {}
    wheel = arrow["tyre"]["contact"][0].rpartition(".")[0]
    ours = {key: f"{wheel}.{key}" for key in ("slip", "slip_angle", "omega")} | {"speed": "speed"}
    slips = {key: named[name].name for key, name in ours.items() if name in named and named[name].scale == 1.0}
    return {"slips": slips} if slips else {}


def _with_columns(part: Mapping[str, Any], named: Mapping[str, Variable]) -> dict[str, Any]:
    return {key: _renamed_column(value, named) if key in _COLUMNS else value for key, value in part.items()}


def _renamed_column(value: Any, named: Mapping[str, Variable]) -> Any:
    if isinstance(value, str):
        return named[value].name if value in named else value
    if isinstance(value, Mapping):
        return {key: _renamed_column(part, named) for key, part in value.items()}
    return [_renamed_column(part, named) for part in value] if isinstance(value, (list, tuple)) else value
