"""Arrays of FMI 3.0 from the one table of variables: components of a vector become one variable."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from fmu_src.variables.variables import Variable

# Last parts of names that stand for one vector, and its name.
_VECTORS = (
    (("x", "y", "z"), "position"),
    (("qw", "qx", "qy", "qz"), "orientation"),
    (("yaw", "pitch", "roll"), "angles"),
    (("vx", "vy", "vz"), "velocity"),
    (("wx", "wy", "wz"), "angular_velocity"),
    (("ax", "ay", "az"), "acceleration"),
    (("Fx", "Fy", "Fz"), "force"),
    (("Mx", "My", "Mz"), "moment"),
    (("axis_x", "axis_y", "axis_z"), "axis"),
    (("contact_x", "contact_y", "contact_z"), "contact"),
    (("normal_x", "normal_y", "normal_z"), "normal"),
)
_NUMBERED = re.compile(r"(.+)_(\d+)((?:\.\w+)?)")


@dataclass(frozen=True)
class Array:
    """One variable of FMI 3.0, whose value reference `references` gives."""

    name: str
    """Unique."""
    items: tuple[int, ...]
    """Places in the table of variables."""
    of: Variable
    """The first of them, for causality, unit and range."""
    description: str


def arrays(table: Sequence[Variable]) -> tuple[Array, ...]:
    """Group the variables of a table.

    Returns vectors where all components are outputs of one unit and follow each other, series of outputs or constants
    such as gauge_1.stress, gauge_2.stress ..., else single variables; in the order of the table.
    """
    groups: list[Array] = []
    grouped: set[int] = set()
    names = {v.name for v in table}
    for i, v in enumerate(table):
        if i in grouped:
            continue
        group = _vector(table, i) or _series(table, i)
        if group is None or group.name in names:
            group = Array(v.name, (i,), v, v.description)
        grouped |= set(group.items)
        groups.append(group)
    return tuple(groups)


def scalars(table: Sequence[Variable]) -> tuple[Array, ...]:
    """Every variable by itself, for hosts that do not read arrays."""
    return tuple(Array(v.name, (i,), v, v.description) for i, v in enumerate(table))


def references(groups: Sequence[Array]) -> tuple[list[int], int]:
    """Value references of the variables of FMI 3.0, in order, and that of time.

    Time stands between the outputs and the constants, so that a constant more moves no reference.
    """
    time = sum(group.of.source != "constant" for group in groups)
    return [k + (k >= time) for k in range(len(groups))], time


def common_text(texts: Sequence[str]) -> str:
    """One text for several: where words differ, those of all, with commas between single words and else semicolons.

    >>> common_text(["x of the centre", "y of the centre"]), common_text(["at gauge 1", "at gauge 2", "at gauge 3"])
    ('x, y of the centre', 'at gauge 1 to 3')
    """
    rows = [text.split() for text in texts]
    least_length = min(map(len, rows))
    if all(row == rows[0] for row in rows):
        return texts[0]
    prefix_length = next((k for k in range(least_length) if len({row[k] for row in rows}) > 1), least_length)
    suffix_length = next(
        (k for k in range(least_length - prefix_length) if len({row[-1 - k] for row in rows}) > 1),
        least_length - prefix_length,
    )
    middles = [" ".join(row[prefix_length : len(row) - suffix_length]) for row in rows]
    if len(rows) > 2 and middles == [str(k) for k in range(1, len(rows) + 1)]:
        middle = f"1 to {len(rows)}"
    else:
        comma = "," if middles[-1].endswith(",") else ""
        middle = (", " if all(" " not in m for m in middles) else "; ").join(m.rstrip(",") for m in middles) + comma
    return " ".join([*rows[0][:prefix_length], middle, *rows[0][len(rows[0]) - suffix_length :]])


def _alike(table: Sequence[Variable], items: Sequence[int]) -> bool:
    reference = table[items[0]]
    kind = (reference.causality, reference.source == "constant", reference.unit, reference.whole)
    return (reference.causality == "output" or reference.source == "constant") and all(
        (table[k].causality, table[k].source == "constant", table[k].unit, table[k].whole) == kind for k in items
    )


def _vector(table: Sequence[Variable], i: int) -> Array | None:
    prefix, dot, suffix = table[i].name.rpartition(".")
    for components, name in _VECTORS:
        items = range(i, i + len(components))
        if suffix != components[0] or items[-1] >= len(table) or not _alike(table, items):
            continue
        if all(table[k].name == prefix + dot + component for k, component in zip(items, components, strict=True)):
            text = common_text([table[k].description for k in items])
            has_names = any(
                ", ".join(names) in text for names in (components, [component[-1] for component in components])
            )
            description = text if has_names else f"{', '.join(components)}: {text}"
            return Array(f"{prefix}{dot}{name}", tuple(items), table[i], description)
    return None


def _series(table: Sequence[Variable], i: int) -> Array | None:
    match = _NUMBERED.fullmatch(table[i].name)
    if match is None or match[2] != "1":
        return None
    indices = {v.name: k for k, v in enumerate(table)}
    items = [i]
    while (k := indices.get(f"{match[1]}_{len(items) + 1}{match[3]}")) is not None:
        items.append(k)
    if len(items) < 2 or not _alike(table, items):
        return None
    description = f"1 to {len(items)}: {common_text([table[k].description for k in items])}"
    return Array(f"{match[1]}{match[3]}", tuple(items), table[i], description)
