"""Reads untrusted JSON files with the limits of `ali3.reading`."""

import json
import os
from collections import Counter
from operator import itemgetter
from typing import Any

from ali3.errors import FileError
from ali3.limits import at_most, raised
from ali3.message_text import brief, one_line
from ali3.reading import Error, check_content, file_text, read_bytes, too_deep

LARGEST_JSON = 100_000_000
MAX_ENTRIES = 3_000_000


def read_json(file: str | os.PathLike[str], error: Error = FileError, name: str = "", finite: bool = True) -> Any:
    """Content of a JSON file; see `check_file` and `json_of`."""
    return json_of(read_bytes(file, LARGEST_JSON, error, name), error, name or str(file), finite)


def json_of(data: bytes, error: Error, name: str, finite: bool = True) -> Any:
    """Content of the bytes of a JSON file: whole numbers have 64 bits, and keys of an object are unique.

    `error`, `name`: see `toml_of`; `finite`: whether NaN and Infinity, which Python writes, are refused.
    """
    if (count := data.count(b",") + data.count(b"[") + data.count(b"{")) > raised(MAX_ENTRIES):
        raise error(f"{name} has {count} entries; it must have {at_most(count, MAX_ENTRIES)}.")
    if not data.strip():
        raise error(f"{name} is empty; it must be a JSON file.")
    try:
        content = json.loads(file_text(data, error, name), object_pairs_hook=_object)
    except _DuplicateKeyError as fault:
        raise error(f"{name} has the key {brief(str(fault))} twice in a table.") from None
    except json.JSONDecodeError as fault:
        raise error(f"{name} is not a JSON file: {one_line(str(fault))}.") from None
    except ValueError:
        raise error(f"{name} is not a readable JSON file: a whole number has more than 19 digits.") from None
    except RecursionError:
        too_deep(error, name)
    check_content(content, error, name, finite)
    return content


class _DuplicateKeyError(Exception):
    """A key occurs twice in an object."""


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    table = dict(pairs)
    if len(table) < len(pairs):
        raise _DuplicateKeyError(max(Counter(key for key, _ in pairs).items(), key=itemgetter(1))[0])
    return table
