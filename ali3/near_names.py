"""Suggests known names that are close to an unknown one."""

from collections.abc import Iterable
from difflib import get_close_matches

MOST = 3  # names in a sentence
_LONGEST = 200  # characters of a name that are compared
_SHORTEST = 3  # characters of a part of a name that names it


def near_names(name: str, known: Iterable[str], most: int = MOST, closeness: float = 0.65) -> list[str]:
    """The names that one is like, the nearest first; capitals do not count.

    Those that are the same but for capitals; else those that are spelt like it; else those with the same last part,
    as ``spring.damping`` for ``car.damping``; else those of which it is a part.

    `name`: which is not among them; `closeness`: least share of characters that two spellings have in common, see
    `difflib.get_close_matches`; 0 to 1.
    """
    requested = name[:_LONGEST].lower()
    spellings: dict[str, list[str]] = {}
    for known_name in known:
        spellings.setdefault(known_name.lower(), []).append(known_name)
    near = [requested] if requested in spellings else get_close_matches(requested, spellings, most, closeness)
    near = near or [
        known_name for known_name in spellings if known_name.rpartition(".")[2] == requested.rpartition(".")[2]
    ]
    if not near and len(requested) >= _SHORTEST:
        near = [known_name for known_name in spellings if requested in known_name]
    return [known_name for key in near for known_name in spellings[key]][:most]


def did_you_mean(
    name: str, known: Iterable[str], otherwise: str = "", most: int = MOST, closeness: float = 0.65
) -> str:
    """The end of a sentence on a name that is not known: ``; did you mean 'a' or 'b'?``.

    `name`, `known`, `most`, `closeness`: see `near_names`; `otherwise`: what the sentence ends with where no name is
    near, without a full stop.
    """
    near = near_names(name, known, most, closeness)
    if near:
        return f"; did you mean {' or '.join(map(repr, near))}?"
    return f"; {otherwise}." if otherwise else "."
