"""Two thin Mach-O files become one universal file."""

import struct
from collections.abc import Sequence

_THIN_MAGIC = 0xFEEDFACF
_FAT_MAGIC = 0xCAFEBABE
_ALIGN = 14  # pages of Apple's ARM processors: 2^14 bytes


def universal(thin: Sequence[bytes]) -> bytes:
    """Join files of different processors. `thin`: 64-bit Mach-O files.

    Result: header, one entry per file (processor, subtype, offset, size, alignment; big endian), then the files at
    aligned offsets. Raises `ValueError` if a file is none, or two are for the same processor.
    """
    entries, body = [], b""
    header_size = 8 + 20 * len(thin)
    for data in thin:
        magic, cpu, subtype = struct.unpack_from("<3I", data)
        if magic != _THIN_MAGIC:
            raise ValueError("This is not a 64-bit Mach-O file.")
        padding = -(header_size + len(body)) % (1 << _ALIGN)
        body += b"\0" * padding
        entries.append((cpu, subtype, header_size + len(body), len(data), _ALIGN))
        body += data
    if len({cpu for cpu, *_ in entries}) != len(entries):
        raise ValueError("Two files are for the same processor.")
    return struct.pack(">2I", _FAT_MAGIC, len(thin)) + b"".join(struct.pack(">5I", *e) for e in entries) + body
