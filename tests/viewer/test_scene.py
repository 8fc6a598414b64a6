"""The format of scenes: one sentence with the place for each fault; the JSON Schema agrees."""

import copy
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from ali3.scene.errors import SceneError
from ali3.scene.scene import check_scene, read_scene, scene_errors
from ali3.scene.scene_values import NAME, UNIT
from tests.viewer.hand_scenes import everything, floats, octets
from viewer.scene_schema import SCHEMA_FILE, json_schema, schema_text

VALIDATOR = jsonschema.Draft202012Validator(json_schema())


def keys(node: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[tuple[Any, ...], str]]:
    """Every key of a scene with the path of its table."""
    for key, value in node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ():
        if isinstance(node, dict):
            yield path, key
        yield from keys(value, (*path, key))


def at(scene: Any, path: tuple[Any, ...]) -> Any:
    for part in path:
        scene = scene[part]
    return scene


PLACES = [place for place in keys(everything()) if place[0] not in (("frames",), ("meshes",))]
OPTIONAL = {
    *("description", "up", "planar", "focus", "start", "at", "name", "body", "axes", "material", "color", "opacity"),
    *("wire", "coils", "rim", "axis", "normals", "stress", "constant", "unit", "limit", "sign", "frictions", "height"),
    *("flexible", "arrows", "roads", "missing", "variable", "path", "rule", "computed", "limit_name"),
    *("names", "note", "range", "direction", "origin", "width", "variables", "file"),
    *("scenery", "colour", "dash", "seed", "length", "gauges"),
}
NEEDED = {(("roads", 1), "origin"), (("shapes", 8), "width"), (("frames", "spinning wheel"), "axis")}
NEEDED |= {(("missing", 0), "name"), (("arrows", 1), "at"), (("flexible", 0, "gauges", 0), "name")}
NEEDED |= {(("roads", 5, "patches", 0), "origin"), (("roads", 5, "surface"), "origin")}
NEEDED |= {(("roads", 5, "surface"), key) for key in ("names", "frictions")} | {(("scenery", 0), "width")}
NEEDED |= {(("scenery", k), "at") for k in (1, 2, 3, 5, 6, 7)} | {(("scenery", 2), "height")}
NEEDED |= {(("arrows", k), "name") for k in range(3)} | {((), "name"), (("arrows", 2, "tyre"), "axis")}


def test_a_scene_with_one_of_each_is_valid_by_types_and_schema() -> None:
    assert scene_errors(everything()) == []
    VALIDATOR.validate(everything())


def test_the_schema_in_the_package_is_that_of_the_types() -> None:
    assert SCHEMA_FILE.read_text(encoding="utf-8") == schema_text()


@pytest.mark.slow
def test_keys_that_are_not_there() -> None:
    wrong = []
    for path, key in PLACES:
        scene = everything()
        del at(scene, path)[key]
        errors, accepted = scene_errors(scene), True
        if key in OPTIONAL and (path, key) not in NEEDED:
            good, accepted = errors == [], VALIDATOR.is_valid(scene)
        elif (path, key) == ((), "meshes"):
            good = errors == ["shapes[5].mesh is 'triangle', which is not a mesh; there are none."]
        elif (path, key) == (("arrows", 2), "tyre"):
            good = errors == ["arrows[2] must have the keys 'value' and 'between', 'vector' and 'at', or 'tyre'."]
        else:
            good = len(errors) == 1 and key in errors[0] and "is missing" in errors[0]
            accepted = not VALIDATOR.is_valid(scene)
        if not (good and accepted):
            wrong.append(f"{path}, {key}: {errors}{'' if accepted else '; the schema says something else'}")
    assert not wrong, "\n".join(wrong)


def test_keys_that_are_misspelt() -> None:
    wrong = []
    for path, key in PLACES:
        scene = everything()
        table = at(scene, path)
        table[f"{key}x"] = table.pop(key)
        errors = scene_errors(scene)
        parts = (f"'{key}'", f"{key} is missing", "or 'tyre'")
        good = len(errors) == 1 and f"{key}x" in errors[0] and any(t in errors[0] for t in parts)
        if not good or "\n" in errors[0]:
            wrong.append(f"{path}, {key}: {errors}")
    assert not wrong, "\n".join(wrong)


ODD_VALUES = (-1, [], {}, [1, 2], True, float("nan"), float("inf"), "</script>\n" * 99, 10**400)


@pytest.mark.slow
def test_any_value_is_good_or_has_one_sentence() -> None:
    wrong = []
    for path, key in PLACES:
        for k, value in enumerate(ODD_VALUES):
            scene = everything()
            at(scene, path)[key] = value
            try:
                errors = scene_errors(scene)
            except Exception as error:
                errors = [repr(error)]
            bad = [s for s in errors if not s.endswith(".") or "\n" in s or len(s) >= 400]
            wrong += [f"{path}, {key}, odd value {k}: {s[:400]}" for s in bad]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize(
    ("path", "value", "sentence"),
    [
        (("shapes", 1, "radius"), -0.1, "shapes[1].radius is -0.1; it must be above 0."),
        (("shapes", 1, "radius"), "1", "shapes[1].radius is '1'; it must be a number."),
        (("shapes", 1, "at"), [0, 0], "shapes[1].at has 2 entries; it must have 3."),
        (("shapes", 3, "points"), [["ground", [0, 0, 0]]], "shapes[3].points has 1 entries; it must have at least 2."),
        (("shapes", 0, "color"), "red", "shapes[0].color is 'red'; it must be a colour such as '#3366cc'."),
        (("shapes", 0, "axes"), [[1, 0, 0], [1, 0, 0], [0, 0, 1]], "shapes[0].axes must be three unit vectors"),
        (("shapes", 0, "axes"), [[1, 0, 0], [0, 1, 0], [0, 0, -1]], "shapes[0].axes must be three unit vectors"),
        (("shapes", 8, "rim"), 0.4, "shapes[8].rim is 0.4; it must be below the radius, 0.3."),
        (("shapes", 8, "axis"), [0, 0, 0], "shapes[8].axis is [0, 0, 0]; it must not be zero."),
        (("shapes", 2, "frame"), "arms", "shapes[2].frame is 'arms', which is not a frame; there are 'ground', 'body'"),
        (
            ("frames", "spinning wheel", "parent"),
            "rim",
            "frames['spinning wheel'].parent is 'rim', which is not a frame",
        ),
        (("frames", "spinning wheel", "parent"), "spinning wheel", "frames['spinning wheel'] depends on itself"),
        (("frames", "arm", "points"), [[0, 0, 0], [1, 0, 0], [2, 0, 0]], "frames.arm.points lie on a line"),
        (("frames", "body", "start"), [[0, 0, 0], [0, 0, 0, 0]], "frames.body.start[1] is [0, 0, 0, 0]; it must not"),
        (("meshes", "triangle", "positions"), "!", "meshes.triangle.positions is not base64."),
        (
            ("meshes", "triangle", "positions"),
            floats([1, 2, 3, 4]),
            "meshes.triangle.normals has 9 numbers; it must have 4",
        ),
        (
            ("meshes", "triangle", "positions"),
            floats([0] * 8 + [float("nan")]),
            "meshes.triangle.positions holds 1 val",
        ),
        (
            ("meshes", "triangle", "triangles"),
            "AAAAAAEAAAADAAAA",
            "meshes.triangle.triangles names corner 3; the largest is 2.",
        ),
        (("flexible", 0, "modes"), floats([1, 2]), "flexible[0].modes has 2 numbers; it must have 6."),
        (("flexible", 0, "beams"), [[0, 2]], "flexible[0].beams[0] names node 2; the largest is 1."),
        (("flexible", 0, "radii"), [], "flexible[0].radii has 0 entries; it must have 1, one for each beam."),
        (("flexible", 0, "stress", "rows"), floats([1]), "flexible[0].stress.rows has 1 numbers; it must have 2."),
        (("flexible", 0, "gauges", 0, "nodes"), [0, 2], "flexible[0].gauges[0].nodes names node 2; the largest is 1."),
        (("flexible", 0, "gauges", 0, "along"), 1.5, "flexible[0].gauges[0].along is 1.5; it must be at most 1."),
        (("flexible", 0, "stress", "rule"), "round", "flexible[0].stress.fibres is 1; the rule 'round' has 3."),
        (("arrows", 1, "axes"), "wing", "arrows[1].axes is 'wing', which is not a frame"),
        (("arrows", 0, "sign"), 2, "arrows[0].sign is 2; it must be 1 or -1."),
        (("roads", 1, "shape"), [2, 3], "roads[1].heights has 4 numbers; it must have 6."),
        (
            ("roads", 5, "surface", "classes"),
            octets([0, 0, 0]),
            "roads[5].surface.classes has 3 numbers; it must have 4.",
        ),
        (("roads", 5, "surface", "classes"), octets([0, 0, 0, 2]), "roads[5].surface.classes names surface 2; the"),
        (("roads", 5, "surface", "frictions"), [1.0], "roads[5].surface.frictions has 1 entries; it must have 2, one"),
        (("roads", 5, "surface", "names"), ["tar", "grass"], "roads[5].surface.names[0] is 'tar'; it must be"),
        (("arrows", 1, "vector"), ["a", 1, "b"], "arrows[1].vector[1] is 1; it must be a text."),
        (("up",), [0, 0, 0], "up is [0, 0, 0]; it must have a direction."),
        (
            ("focus",),
            "moon",
            "focus is 'moon', which is not a frame; there are 'ground', 'body', 'spinning wheel', 'arm'.",
        ),
        (("version",), 2, "version is 2; this viewer reads version 1."),
        (("format",), "glTF", "format is 'glTF'; it must be 'ALi3 scene'."),
        (("frames", "body"), None, "frames.body is null; it must be a table."),
        (("frames", "body"), {"start": 1}, "frames.body must have the keys 'position' and 'quaternion', 'parent'"),
    ],
)
def test_sentences(path: tuple[Any, ...], value: Any, sentence: str) -> None:
    scene = everything()
    at(scene, path[:-1])[path[-1]] = value
    errors = scene_errors(scene)
    assert errors[0].startswith(sentence), errors[0]
    with pytest.raises(SceneError, match=r"^car\.json: "):
        check_scene(scene, "car.json")


def test_null_stands_for_a_key_that_is_left_out() -> None:
    scene = everything()
    scene["shapes"][0]["color"] = None
    assert scene_errors(scene) == []
    scene["shapes"][0]["size"] = None
    assert scene_errors(scene) == ["shapes[0].size is missing."]


@pytest.mark.parametrize("content", [b"", b"{", b"\xff\xfe", b"[1]", b"[" * 100_000, b'"scene"'])
def test_a_file_that_is_no_scene(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "scene.json").write_bytes(content)
    with pytest.raises(SceneError, match=r"scene\.json") as error:
        read_scene(tmp_path / "scene.json")
    assert "\n" not in str(error.value)


def test_a_file_of_a_scene_is_read(tmp_path: Path) -> None:
    (tmp_path / "scene.json").write_text(json.dumps(everything()))
    assert read_scene(tmp_path / "scene.json") == everything()
    assert read_scene(json.dumps(everything()).encode()) == everything()


def test_checking_changes_nothing() -> None:
    scene = everything()
    before = copy.deepcopy(scene)
    check_scene(scene)
    assert scene == before


def test_the_page_checks_names_and_units_by_the_same_patterns() -> None:
    text = (Path(__file__).parents[2] / "viewer/page/src/scene/plain_names.js").read_text(encoding="utf-8")
    assert re.findall(r"const (\w+) = /(.+)/;", text) == [("NAME", NAME), ("UNIT", UNIT)]


@pytest.mark.parametrize("unit", ["N", "N.m", "rad/s2", "1", "%", "°C", "l/(100 km)", "µm", "kg·m²", "N*m/rad", ""])
def test_units_that_are_used_are_units(unit: str) -> None:
    scene = everything()
    scene["arrows"][0]["unit"] = unit
    assert scene_errors(scene) == []
