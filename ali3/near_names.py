"""Suggests known names that are close to an unknown one."""

from collections.abc import Iterable
from difflib import get_close_matches

MOST = 3  # names in a sentence
_MAX_LENGTH = 200  # characters of a name that are compared
_MIN_PART = 3  # characters of a part that matches the whole name


def near_names(name: str, known: Iterable[str], most: int = MOST, closeness: float = 0.65) -> list[str]:
    """Known names that are similar to an unknown one, the nearest first.

    The first of these that finds any: names equal but for capital letters; names of similar spelling; names with the
    same last part (``spring.damping`` for ``car.damping``); names that contain it.

    `closeness`: lowest similarity, 0 to 1, see `difflib.get_close_matches`.
    """
    requested = name[:_MAX_LENGTH].lower()
    spellings: dict[str, list[str]] = {}
    for known_name in known:
        spellings.setdefault(known_name.lower(), []).append(known_name)
    near = [requested] if requested in spellings else []
    if not near:
        near = get_close_matches(requested, spellings, most, closeness)
    if not near:
        last_part = requested.rpartition(".")[2]
        near = [known_name for known_name in spellings if known_name.rpartition(".")[2] == last_part]
    if not near and len(requested) >= _MIN_PART:
        near = [known_name for known_name in spellings if requested in known_name]
    return [known_name for key in near for known_name in spellings[key]][:most]


def did_you_mean(
    name: str, known: Iterable[str], otherwise: str = "", most: int = MOST, closeness: float = 0.65
) -> str:
    """End of a message about an unknown name: ``; did you mean 'a' or 'b'?``.

    `name`, `known`, `most`, `closeness`: see `near_names`; `otherwise`: said if no name is near, without a full stop.
    """
    near = near_names(name, known, most, closeness)
    if near:
        return f"; did you mean {' or '.join(map(repr, near))}?"
    return f"; {otherwise}." if otherwise else "."
