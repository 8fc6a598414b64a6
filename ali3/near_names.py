"""Suggests known names that are close to an unknown one."""

from collections.abc import Iterable
from difflib import get_close_matches

MOST = 3  # names in a sentence
_LONGEST_NAME = 200  # characters of a name that are compared
_SHORTEST_PART = 3  # characters of a part that matches the whole name


def near_names(name: str, known: Iterable[str], most: int = MOST, closeness: float = 0.65) -> list[str]:
    """Known names that are similar to an unknown one, the nearest first.

    They are equal in small letters; else similar in spelling; else they have the same last part, such as
    ``spring.damping`` for ``car.damping``; else they contain the name.

    `closeness`: least similarity of two spellings, 0 to 1, see `difflib.get_close_matches`.
    """
    requested = name[:_LONGEST_NAME].lower()
    spellings: dict[str, list[str]] = {}
    for known_name in known:
        spellings.setdefault(known_name.lower(), []).append(known_name)
    near = [requested] if requested in spellings else get_close_matches(requested, spellings, most, closeness)
    near = near or [
        known_name for known_name in spellings if known_name.rpartition(".")[2] == requested.rpartition(".")[2]
    ]
    if not near and len(requested) >= _SHORTEST_PART:
        near = [known_name for known_name in spellings if requested in known_name]
    return [known_name for key in near for known_name in spellings[key]][:most]


def did_you_mean(
    name: str, known: Iterable[str], otherwise: str = "", most: int = MOST, closeness: float = 0.65
) -> str:
    """The end of a sentence on a name that is not known: ``; did you mean 'a' or 'b'?``.

    `name`, `known`, `most`, `closeness`: see `near_names`; `otherwise`: end of the sentence without a full stop if no
    name is near.
    """
    near = near_names(name, known, most, closeness)
    if near:
        return f"; did you mean {' or '.join(map(repr, near))}?"
    return f"; {otherwise}." if otherwise else "."
