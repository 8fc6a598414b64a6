"""Files that are cut, of which bytes or lines are changed, or in which values have another type; by a seed."""

import random
import re

_KINDS = ("cut", "byte", "bytes out", "twice", "token", "token", "token", "line out", "lines swapped")
_TOKENS = re.compile(rb"[^\s,;=\[\]{}:\"']+")
_OTHER = (
    *(b"", b"x", b"-", b"nan", b"inf", b"-1", b"0", b"1e308", b"-1e308", b"1e-320", b"9" * 25, b"true", b"null"),
    *(
        b"[]",
        b"{}",
        b"[1]",
        b'{"a": 1}',
        b'"x"',
        b"1970-01-01",
        b"\xff",
        b"\x00",
        b"#",
        b'"',
        b"[",
        b"/dev/zero",
        b"..",
    ),
)


def altered(content: bytes, seed: int) -> bytes:
    """The content with one to three alterations."""
    chance = random.Random(seed)
    for _ in range(chance.choice((1, 1, 1, 2, 3))):
        size = len(content)
        kind = chance.choice(_KINDS)
        one, other = sorted(chance.randrange(size + 1) for _ in range(2))
        lines = content.split(b"\n")
        tokens = [found.span() for found in _TOKENS.finditer(content[:200_000])]
        if kind == "cut":
            content = content[:one]
        elif kind == "byte" and one < size:
            content = content[:one] + bytes([chance.randrange(256)]) + content[one + 1 :]
        elif kind == "bytes out":
            content = content[:one] + content[min(other, one + 200) :]
        elif kind == "twice":
            content = content[: min(other, one + 200)] + content[one:]
        elif kind == "token" and tokens:
            begin, end = chance.choice(tokens)
            content = content[:begin] + chance.choice(_OTHER) + content[end:]
        elif kind == "line out":
            lines.pop(chance.randrange(len(lines)))
            content = b"\n".join(lines)
        elif kind == "lines swapped":
            k, n = chance.randrange(len(lines)), chance.randrange(len(lines))
            lines[k], lines[n] = lines[n], lines[k]
            content = b"\n".join(lines)
    return content
