"""Parts common to all FMU archives: identity, licence and reproducible zip files."""

import hashlib
import importlib.metadata
import json
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ali3.files import atomic_file

# The earliest time a zip can carry.
_ZIP_DATE = (1980, 1, 1, 0, 0, 0)


def identity_of(entries: Mapping[str, bytes], more: Any) -> tuple[str, str]:
    """Hash of the content.

    `entries`: files by name; `more`: anything else that makes this FMU what it is.

    Returns
    -------
    identity : str
        32 hexadecimal digits.
    guid : str
        The same as a GUID in braces.
    """
    digest = hashlib.sha256()
    for name in sorted(entries):
        digest.update(name.encode() + b"\0" + hashlib.sha256(entries[name]).digest())
    digest.update(json.dumps(more, sort_keys=True).encode())
    text = digest.hexdigest()[:32]
    return text, f"{{{text[:8]}-{text[8:12]}-{text[12:16]}-{text[16:20]}-{text[20:]}}}"


def licence(distribution: str) -> bytes:
    """The licence text an installed distribution carries."""
    files = importlib.metadata.files(distribution) or []
    texts = [Path(str(f.locate())).read_bytes() for f in files if f.name.upper().startswith("LICENSE")]
    if not texts:
        raise RuntimeError(f"The licence of '{distribution}' is not installed with it; install the package again.")
    return texts[0]


def write_zip(files: Mapping[str, bytes], file: Path) -> None:
    """Write an archive; an older file is replaced only when the new one is whole."""
    # One level for all: the same content gives the same bytes with the same zlib; the identity is of the content alone.
    with (
        atomic_file(file) as temporary,
        zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive,
    ):
        # The description first: readers that stream find it at once.
        for name in sorted(files, key=lambda n: (n != "modelDescription.xml", n)):
            info = zipfile.ZipInfo(name, _ZIP_DATE)
            info.create_system = 3
            info.compress_type = zipfile.ZIP_DEFLATED
            info.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            archive.writestr(info, files[name], compresslevel=9)
