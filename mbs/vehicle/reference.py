"""``python -m mbs.vehicle.reference`` prints the reference of the car file, and writes its JSON Schema in a clone."""

import inspect
import textwrap
from collections.abc import Iterator
from typing import Any

from pydantic.fields import FieldInfo

from ali3.files import write_text
from ali3.typed_paths import Table, annotation_of, keys_of, kinds_of, templates, value_type_of, words
from mbs.vehicle.car import Car
from mbs.vehicle.quantities import Quantity, quantities_in
from mbs.vehicle.schema import SCHEMA_FILE, schema_text

LINE_WIDTH = 118
NAME_PLACEHOLDER = "NAME"  # of a name that the user chooses
AXLE_PLACEHOLDER = "AXLE"  # of "front" or "rear"
TOP_HEADING = "At the top of the file"
COLUMNS = ("key", "value", "unit", "range", "default", "FMU", "what it is")


def tables() -> str:
    """Reference of the car file: a heading and a table of keys for each table of the file."""
    sections = []
    for table, locations in _locations_by_table().items():
        paths = list(dict.fromkeys(path for path, _ in locations))
        kinds = list(dict.fromkeys(kind for _, kind in locations if kind))
        text = inspect.cleandoc(table.__doc__ or "").replace("``", "`")
        blocks = [textwrap.fill(" ".join(p.split()), LINE_WIDTH) for p in text.split("\n\n")]
        quoted = [f"`{path}`" for path in paths]
        if len(paths) > 2:
            heading = _heading(table)
            blocks.append(textwrap.fill(f"Stands at {', '.join(quoted)}.", LINE_WIDTH, break_on_hyphens=False))
        else:
            kind = f", {kinds[0]}" if len(kinds) == 1 else ""
            heading = (TOP_HEADING if paths == [""] else " and ".join(quoted)) + kind
        rows = [_key_row(key, field) for key, field in keys_of(table).items()]
        blocks.append("\n".join(_table_line(row) for row in [COLUMNS, ("---",) * len(COLUMNS), *rows]))
        sections.append("\n\n".join([f"## {heading}", *blocks]) + "\n")
    return "\n".join(sections)


def _heading(table: Table) -> str:
    """Heading of a table with more than two key paths: the first words of its docstring."""
    return inspect.cleandoc(table.__doc__ or "").partition("\n")[0].partition(";")[0].partition(",")[0].rstrip(".")


def _locations_by_table() -> dict[Table, list[tuple[str, str]]]:
    """Tables with their key paths and templates, in the order of the file."""
    locations: dict[Table, list[tuple[str, str]]] = {}
    for table, path, kind in _nested_tables(Car, "", ""):
        head, dot, tail = path.partition(".")
        location = f"{AXLE_PLACEHOLDER}{dot}{tail}" if head in ("front", "rear") else path
        locations.setdefault(table, []).append((location, kind))
    return locations


def _nested_tables(table: Table, path: str, kind: str) -> Iterator[tuple[Table, str, str]]:
    """Yield a table and the tables in it with their key paths and templates, in the order of the file."""
    kind = ", ".join(kinds_of(table)) or kind
    yield table, path, kind
    for key, field in keys_of(table).items():
        key_path = f"{path}.{key}" if path else key
        named = value_type_of(field.annotation)
        for inner in templates(field.annotation if named is None else named):
            yield from _nested_tables(inner, key_path if named is None else f"{key_path}.{NAME_PLACEHOLDER}", kind)


def _key_row(key: str, field: FieldInfo) -> tuple[str, ...]:
    """Cells of a key, one per column."""
    annotation = annotation_of(field)
    quantities = quantities_in(annotation)
    text = " ".join((field.description or "").split())
    if field.is_required():
        default = ""
    else:
        default = "optional" if field.default_factory or field.default is None else _default_text(field.default)
    units = "; ".join(quantity.unit for quantity in quantities)
    limits = "; ".join(map(_range_text, quantities))
    change = next((q.change for q in quantities if q.change is not None), "")
    return f"`{key}`", _value_text(annotation), units, limits, default, change, text


def _range_text(quantity: Quantity) -> str:
    limits = f"{quantity.low:g}" if quantity.low == quantity.high else f"{quantity.low:g} to {quantity.high:g}"
    return f"0 or {limits}" if quantity.zero and quantity.low > 0.0 else limits


def _value_text(annotation: Any) -> str:
    """Type of a value in words, without its range."""
    named = value_type_of(annotation)
    if named is not None:
        return (
            f"tables by `{NAME_PLACEHOLDER}`" if templates(named) else f"{_value_text(named)} by `{NAME_PLACEHOLDER}`"
        )
    tables = templates(annotation)
    if tables:
        kinds = [kind for table in tables for kind in kinds_of(table)]
        return "table" + (f", kind {' or '.join(map(repr, kinds))}" if len(kinds) > 1 else "")
    text = words(annotation)
    for quantity in quantities_in(annotation):  # their ranges have a column
        text = text.replace(f", {quantity.range}", "")
    return text.removeprefix("a ")


def _default_text(value: object) -> str:
    if isinstance(value, tuple):
        return "[" + ", ".join(map(_default_text, value)) + "]"
    return f"{value:g}" if isinstance(value, float) else f"`{value!r}`"


def _table_line(cells: tuple[str, ...]) -> str:
    """A line of a Markdown table."""
    return "| " + " | ".join(cells) + " |"


def main() -> None:
    """Write the schema and print the reference."""
    print(tables())
    write_text(SCHEMA_FILE, schema_text())


if __name__ == "__main__":
    main()
