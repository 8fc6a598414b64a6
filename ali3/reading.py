"""Reads untrusted files: regular files of limited size; each fault is one sentence that names the file.

Pipes and devices could block, and deeply nested lists, very long numbers and keys of very many parts could stop the
parsers or the programs that use the content.
"""

import codecs
import math
import os
import re
import stat
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, BinaryIO, NoReturn

from ali3.errors import FileError, reason
from ali3.limits import at_most, raised
from ali3.message_text import brief, one_line, place_text

Error = type[Exception]

LARGEST_TOML = 1_000_000
"""Largest TOML file, bytes; parsing it takes a second."""
LARGEST_TEXT = 10_000_000
"""Largest file of text, bytes."""
LARGEST_STATE = 100_000_000
"""Largest saved state of an FMU, bytes."""
LARGEST_IN_PARTS = 2**40
"""Largest size of a file that is read in parts, bytes."""
MAX_LINE = 10_000_000
"""Longest line of a text, bytes or characters."""
DEEPEST = 100
"""Deepest nesting of lists and tables."""
LARGEST_WHOLE = 2**63 - 1
"""Largest whole number of TOML, a signed integer of 64 bits; the smallest is -2**63."""
_MAX_NAME = 1000  # characters of the name of a missing file in a sentence
_MAX_DOTS = 200  # of a key: the time of the parser is proportional to their square
_STRINGS_AND_COMMENTS = re.compile(
    "|".join(
        (
            r'"{3}[^"\\]*(?:(?:\\.|"{1,2}(?!"))[^"\\]*)*(?:"{3,5}|\\?\Z)',
            r"'{3}.*?(?:'{3,5}|\Z)",
            r'"[^"\\\n]*(?:\\[^\n][^"\\\n]*)*"?',
            r"'[^'\n]*'?",
            r"#[^\n]*",
        )
    ),
    re.DOTALL,
)
"""Strings and comments of a TOML file. Strings without an end match, too, so that the time is linear."""


def check_file(file: str | os.PathLike[str], largest: int, error: Error = FileError, name: str = "") -> Path:
    """Check before a file is opened that it is regular and not too large.

    `largest`: bytes, multiplied by the factor of `ali3.limits`; `error`: raised with one sentence; `name`: name of the
    file in the sentence, by default its path.
    """
    name = name or str(file)
    try:
        status = Path(file).stat()
    except FileNotFoundError:
        raise error(f"{name} cannot be read: there is no such file.") from None
    except OSError as fault:
        raise error(f"{name} cannot be read: {reason(fault)}.") from None
    except ValueError as fault:
        raise error(f"{brief(name)} is not a file name: {fault}.") from None
    if not stat.S_ISREG(status.st_mode):
        raise error(_not_regular(name, status.st_mode))
    if status.st_size > raised(largest):
        raise error(f"{name} has {status.st_size} bytes; it must have {at_most(status.st_size, largest)}.")
    return Path(file)


def missing_file_text(file: str | os.PathLike[str], hint: str = "") -> str:
    """A sentence on a path that is not a regular file; `hint` is appended if nothing exists there."""
    try:
        return _not_regular(str(file), Path(file).stat().st_mode)
    except (OSError, ValueError):
        return f"There is no file {brief(str(file)) if len(str(file)) > _MAX_NAME else one_line(str(file))}.{hint}"


def _not_regular(name: str, mode: int) -> str:
    return f"{name} is {'a folder' if stat.S_ISDIR(mode) else 'a pipe or device'}; it must be a file."


def is_file(file: str | os.PathLike[str]) -> bool:
    """Whether a path is a regular file; false for invalid names, with a zero byte or too long."""
    return stat.S_ISREG(_file_mode(file))


def is_folder(file: str | os.PathLike[str]) -> bool:
    """Whether a path is a folder; see `is_file`."""
    return stat.S_ISDIR(_file_mode(file))


def is_file_or_folder(file: str | os.PathLike[str]) -> bool:
    """Whether a path is a regular file or a folder; see `is_file`."""
    mode = _file_mode(file)
    return stat.S_ISREG(mode) or stat.S_ISDIR(mode)


def _file_mode(file: str | os.PathLike[str]) -> int:
    try:
        return Path(file).stat().st_mode
    except (OSError, ValueError):
        return 0


def open_file(file: str | os.PathLike[str], largest: int, error: Error = FileError, name: str = "") -> BinaryIO:
    """Open a file to read its bytes in parts; see `check_file`."""
    path, name = check_file(file, largest, error, name), name or str(file)
    try:
        return path.open("rb")
    except OSError as fault:
        raise error(f"{name} cannot be read: {reason(fault)}.") from None


def read_bytes(file: str | os.PathLike[str], largest: int, error: Error = FileError, name: str = "") -> bytes:
    """Content of a file; see `check_file`."""
    name = name or str(file)
    try:
        with open_file(file, largest, error, name) as stream:
            size, limit = os.fstat(stream.fileno()).st_size, raised(largest)
            data = stream.read(min(size, limit) + 1)  # `read` allocates as much memory as it is asked for
            if size < len(data) <= limit:  # files of /proc are larger than their stated size
                data += stream.read(limit + 1 - len(data))
    except OSError as fault:
        if isinstance(fault, error):
            raise
        raise error(f"{name} cannot be read: {reason(fault)}.") from None
    if len(data) > limit:
        raise error(f"{name} has more than {limit} bytes.")
    return data


def read_text(file: str | os.PathLike[str], largest: int, error: Error = FileError, name: str = "") -> str:
    """Text of a file in UTF-8, without a byte order mark; see `check_file`."""
    return file_text(read_bytes(file, largest, error, name), error, name or str(file))


def read_toml(
    file: str | os.PathLike[str], error: Error = FileError, name: str = "", largest: int = LARGEST_TOML
) -> dict[str, Any]:
    """Tables of a TOML file; see `check_file` and `toml_of`."""
    return toml_of(read_bytes(file, largest, error, name), error, name or str(file))


def toml_of(data: bytes, error: Error, name: str) -> dict[str, Any]:
    """Tables of the content of a TOML file: numbers are finite, whole numbers have 64 bits.

    `data`: bytes, whose number the caller limits; `error`: raised with one sentence; `name`: name of the file in the
    sentence.
    """
    text = file_text(data, error, name)
    text_of_keys = _STRINGS_AND_COMMENTS.sub("", text)
    if any(part.count(".") > _MAX_DOTS for part in re.split(r"[,=\[\]{}\n]", text_of_keys)):
        raise error(f"{name} is not a readable TOML file: a key has more than {_MAX_DOTS} parts.")
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as fault:
        raise error(f"{name} is not a TOML file: {one_line(str(fault)).rstrip('.')}.") from None
    except ValueError:  # of `int`, which limits the number of digits
        raise error(f"{name} is not a readable TOML file: a whole number has more than 19 digits.") from None
    except RecursionError:
        too_deep(error, name)
    check_content(content, error, name, finite=True)
    return content


def file_text(data: bytes, error: Error, name: str) -> str:
    """Text of the content of a file in UTF-8, without a byte order mark."""
    if message := other_encoding(data):
        raise error(f"{name} is {message}.")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        raise error(f"{name} is not text in UTF-8: byte {fault.start} is not.") from None


def other_encoding(data: bytes) -> str:
    """Predicate for a text in UTF-16 or UTF-32, by its byte order mark or its zero bytes; empty for other texts."""
    is_utf_32 = data.startswith((codecs.BOM_UTF32_LE, codecs.BOM_UTF32_BE))
    is_utf_16 = len(data) > 3 and data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    if not is_utf_32 and not is_utf_16:
        zeros = [k % 2 for k, byte in enumerate(data[:200]) if not byte]
        is_utf_16 = len(zeros) > max(3, len(data[:200]) // 4) and len({*zeros}) == 1
    return f"written in UTF-{32 if is_utf_32 else 16}; it must be in UTF-8" if is_utf_32 or is_utf_16 else ""


def too_deep(error: Error, name: str) -> NoReturn:
    """Refuse content that is nested too deeply."""
    raise error(f"{name} cannot be read: its lists or tables are nested more than {DEEPEST} deep.")


def check_content(content: Any, error: Error, name: str, finite: bool) -> None:
    """Check nesting and numbers of parsed content."""
    stack: list[tuple[Any, tuple[Any, ...], int]] = [([content], (), 0)]
    while stack:
        content_part, key_chain, depth = stack.pop()
        if depth > DEEPEST:
            too_deep(error, name)
        for key, value in content_part.items() if isinstance(content_part, dict) else enumerate(content_part):
            if isinstance(value, (dict, list)):
                stack.append((value, (key_chain, key), depth + 1))
            elif isinstance(value, int):
                if not -LARGEST_WHOLE - 1 <= value <= LARGEST_WHOLE:
                    raise error(f"{name}: {_location((key_chain, key))} is a whole number that 64 bits cannot hold.")
            elif finite and isinstance(value, float) and not math.isfinite(value):
                raise error(f"{name}: {_location((key_chain, key))} is {value}; it must be a finite number.")


def _location(key_chain: tuple[Any, ...]) -> str:
    """A location from the chain of keys of `check_content`."""
    parts: list[int | str] = []
    while key_chain:
        key_chain, key = key_chain
        parts.append(key)
    return one_line(place_text(parts[-2::-1])) or "the content"  # without the list around it


def files_in(content: Any, folder: Path) -> Iterator[Path]:
    """Paths of regular files that texts of parsed content name. `folder`: where relative names begin."""
    if isinstance(content, str):
        if is_file(path := folder / content):
            yield path
    elif isinstance(content, (Mapping, list, tuple)):
        for item in content.values() if isinstance(content, Mapping) else content:
            yield from files_in(item, folder)
