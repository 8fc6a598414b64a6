"""Texts of a model that go into the XML documents of an FMU."""

import re
from collections.abc import Sequence

from fmu_src.variables.variables import Variable
from mbs.common.checks import shown

# XML 1.0, production 2: characters that no document can hold, escaped or not.
_FORBIDDEN = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def check_texts(description: str, rights: Sequence[str], table: Sequence[Variable]) -> None:
    """Refuse texts with characters that XML cannot hold. `rights`: author, copyright, licence.

    Raises `ValueError` with the text, the character and its place.
    """
    texts = {"description of the model": description}
    texts |= dict(zip(("author", "copyright", "licence"), rights, strict=True))
    texts |= {f"description of '{v.name}'": v.description for v in table}
    texts |= {f"name {v.name!a}": v.name for v in table}
    for label, text in texts.items():
        if not isinstance(text, str):
            raise ValueError(f"The {label} must be text, not {shown(text)}.")
        match = _FORBIDDEN.search(text)
        if match:
            raise ValueError(
                f"The {label} has the character U+{ord(match[0]):04X} at place {match.start() + 1}, "
                "which no XML document can hold; leave it out."
            )
