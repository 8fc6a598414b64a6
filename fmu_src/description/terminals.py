"""Terminals of an FMI 3.0 FMU: buses of named parts, plugs of ports, maps of tables."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple
from xml.etree import ElementTree

from fmu_src.description.description import to_bytes
from fmu_src.description.layered_standards import manifest
from fmu_src.variables.arrays import Array
from mbs.elements.road import ANSWER

LS_STRUCT = "org.fmi-standard.fmi-ls-struct"
"""Of modelica/fmi-ls-struct, whose terminals are maps: the release candidate 1 of 1.0."""
MAPS = f"{LS_STRUCT}.map"


class Member(NamedTuple):
    """Variable of a terminal."""

    variable: str
    """Its name; in `_PLUGS` the last part of it."""
    name: str
    """Name of the member, which a partner has too."""
    kind: str
    """variableKind of FMI 3.0."""


class Terminal(NamedTuple):
    """Terminal, with its members in order."""

    name: str
    rule: str
    """matchingRule of FMI 3.0."""
    members: Sequence[Member]
    kind: str = ""
    """terminalKind; empty: none."""


def terminals(arrays: Sequence[Array]) -> bytes:
    """terminalsAndIcons.xml, with the place of the icon.

    A terminal for each part of the model that has a name and more than one variable from outside or to outside, one
    for the inputs without such a name, one for each table, and one for each port.
    """
    root = ElementTree.Element("fmiTerminalsAndIcons", fmiVersion="3.0")
    picture = ElementTree.SubElement(root, "GraphicalRepresentation")
    corners = {"x1": "-100", "y1": "-100", "x2": "100", "y2": "100"}
    ElementTree.SubElement(picture, "CoordinateSystem", corners | {"suggestedScalingFactorTo_mm": "0.1"})
    ElementTree.SubElement(picture, "Icon", corners)
    described = [*_buses(arrays), *_maps(arrays), *_plugs(arrays)]
    parent = ElementTree.SubElement(root, "Terminals") if described else root
    for terminal in described:
        kind = {"terminalKind": terminal.kind} if terminal.kind else {}
        element = ElementTree.SubElement(parent, "Terminal", {"name": terminal.name} | kind, matchingRule=terminal.rule)
        for m in terminal.members:
            attributes = {"variableName": m.variable, "memberName": m.name, "variableKind": m.kind}
            ElementTree.SubElement(element, "TerminalMemberVariable", attributes)
    return to_bytes(root)


def map_manifest(arrays: Sequence[Array]) -> dict[str, bytes]:
    """Manifest of the layered standard by which terminals are maps, by its path; empty if there are no tables."""
    if not _tables(arrays):
        return {}
    description = "Layered standard for structuring of variables"
    root = manifest("fmiLayeredStandardManifest", name=LS_STRUCT, version="1.0.0-rc.1", description=description)
    return {f"extra/{LS_STRUCT}/fmi-ls-manifest.xml": to_bytes(root)}


def _buses(arrays: Sequence[Array]) -> Iterator[Terminal]:
    """A terminal for the inputs without a part, then one for each part."""
    groups: dict[str, list[Array]] = {}
    for array in arrays:
        prefix, _, _ = array.name.rpartition(".")
        if array.of.causality == "input" or (prefix and array.of.causality == "output"):
            groups.setdefault(prefix, []).append(array)
    controls = groups.pop("", [])
    if controls:
        has_steering = "steering" in {array.name for array in controls}
        groups = {"driver" if has_steering and "driver" not in groups else "inputs": controls} | groups
    for name, members in groups.items():
        if len(members) > 1:
            yield Terminal(name, "bus", [Member(a.name, _last_part(a.name), "signal") for a in members])


def _tables(arrays: Sequence[Array]) -> dict[str, list[Array]]:
    """Arrays of constants of one length under one name: the points of a table, then its values there."""
    by_prefix: dict[str, list[Array]] = {}
    for array in arrays:
        prefix, _, _ = array.name.rpartition(".")
        if array.of.source == "constant" and len(array.items) > 1 and prefix:
            by_prefix.setdefault(prefix, []).append(array)
    return {
        name: members
        for name, members in by_prefix.items()
        if len(members) > 1 and len({len(a.items) for a in members}) == 1
    }


def _maps(arrays: Sequence[Array]) -> Iterator[Terminal]:
    """A terminal for each table, as a map from its points to its values."""
    for name, (points, *values) in _tables(arrays).items():
        members = [Member(points.name, _last_part(points.name), f"{MAPS}.domain")]
        members += [Member(a.name, _last_part(a.name), f"{MAPS}.codomain") for a in values]
        yield Terminal(name, MAPS, members, f"{MAPS}.rectilinearGrid")


def _last_part(name: str) -> str:
    return name.rpartition(".")[2]


def _members(kind: str, *names: str) -> list[Member]:
    """Members with the last part of the names of their variables."""
    return [Member(name, name, kind) for name in names]


_WRENCH = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
_PLUGS = {
    "drive_torque": Terminal(
        "drive_torque_port", "plug", [Member("drive_torque", "flow", "inflow"), Member("omega", "potential", "signal")]
    ),
    "steering_rack_actuator_force": Terminal(
        "steering_rack_actuator_force_port",
        "plug",
        [Member("steering_rack_actuator_force", "flow", "inflow"), Member("steering_rack", "potential", "signal")],
    ),
    "road_x": Terminal(
        "road_port",
        "plug",
        [
            *(Member(f"road_{name}", name, "signal") for name in ANSWER),
            *_members("signal", "contact", "contact_x", "contact_y", "contact_z"),
            *(Member(f"road_ahead_{c}", f"ahead_{c}", "signal") for c in "xy"),
        ],
    ),
    "hub_Fx": Terminal(
        "hub_port",
        "plug",
        [
            *(Member(f"hub_{name}", name, "inflow") for name in _WRENCH),
            *_members("signal", "position", "x", "y", "z", "axis", "axis_x", "axis_y", "axis_z"),
            *(Member(f"earth_v{c}", f"v{c}", "signal") for c in "xyz"),
            *_members("signal", "axis_rate_x", "axis_rate_y", "axis_rate_z", "omega"),
        ],
    ),
    "Fx": Terminal(
        "port",
        "plug",
        [
            *_members("inflow", *_WRENCH),
            *_members("signal", "position", "x", "y", "z", "velocity", "vx", "vy", "vz"),
        ],
    ),
}
"""Terminals of ports, by the last part of the name of the first variable. A model may lack some of the members."""


def _plugs(arrays: Sequence[Array]) -> Iterator[Terminal]:
    """A terminal for each port of which the model has more than one member."""
    names = {(array.of.ours if len(array.items) == 1 else "") or array.name: array.name for array in arrays}
    for ours, array in zip(names, arrays, strict=True):
        prefix, dot, suffix = ours.rpartition(".")
        if not array.of.port or suffix not in _PLUGS:
            continue
        plug, start = _PLUGS[suffix], f"{prefix}{dot}"
        members = [m._replace(variable=names[start + m.variable]) for m in plug.members if start + m.variable in names]
        if len(members) > 1:
            yield plug._replace(name=start + plug.name, members=members)
