"""Random alterations of files: cut, changed or repeated bytes, lines out of order, values of another type."""

import random
import re

_KINDS = ("cut", "byte", "bytes out", "twice", "token", "token", "token", "line out", "lines swapped")
_TOKENS = re.compile(rb"[^\s,;=\[\]{}:\"']+")
_REPLACEMENTS = (
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
    """The content with one to three alterations, equal for equal seeds."""
    rng = random.Random(seed)
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        size = len(content)
        kind = rng.choice(_KINDS)
        begin_byte, end_byte = sorted(rng.randrange(size + 1) for _ in range(2))
        lines = content.split(b"\n")
        tokens = [match.span() for match in _TOKENS.finditer(content[:200_000])]
        if kind == "cut":
            content = content[:begin_byte]
        elif kind == "byte" and begin_byte < size:
            content = content[:begin_byte] + bytes([rng.randrange(256)]) + content[begin_byte + 1 :]
        elif kind == "bytes out":
            content = content[:begin_byte] + content[min(end_byte, begin_byte + 200) :]
        elif kind == "twice":
            content = content[: min(end_byte, begin_byte + 200)] + content[begin_byte:]
        elif kind == "token" and tokens:
            begin, end = rng.choice(tokens)
            content = content[:begin] + rng.choice(_REPLACEMENTS) + content[end:]
        elif kind == "line out":
            lines.pop(rng.randrange(len(lines)))
            content = b"\n".join(lines)
        elif kind == "lines swapped":
            k, n = rng.randrange(len(lines)), rng.randrange(len(lines))
            lines[k], lines[n] = lines[n], lines[k]
            content = b"\n".join(lines)
    return content
