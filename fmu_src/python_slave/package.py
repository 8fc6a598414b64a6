"""Packs a System, the kernel, the slave and PythonFMU into an FMU: the same content gives the same bytes."""

from __future__ import annotations

import hashlib
import html
import importlib.metadata
import json
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pythonfmu

from fmu_src.description import Description, model_description
from fmu_src.platforms import SUFFIXES
from fmu_src.variables import Variable, table_records

_HERE = Path(__file__).parent
_PYTHONFMU = Path(pythonfmu.__file__).parent
_PYTHONFMU_MODULES = ("_version", "default_experiment", "enums", "fmi2slave", "logmsg", "variables")
_PYTHONFMU_LIBRARY = {"linux64": "libpythonfmu-export.so", "win64": "pythonfmu-export.dll"}
# The earliest time a zip can carry.
_ZIP_DATE = (1980, 1, 1, 0, 0, 0)


@dataclass(frozen=True)
class Contents:
    """What goes into an FMU.

    Parameters
    ----------
    model_name : str
        A Python and C identifier, also the model identifier.
    description : str
        One sentence.
    version : str
        Of the product.
    systems : sequence of bytes
        System files, one per fidelity.
    table : sequence of Variable
    rows : sequence of sequences of str
        Names of the constraint rows of each System, for messages.
    stop_time, step_size : float
        Default experiment, s.
    binding : Path
        The ctypes binding of the kernel, self-contained.
    kernels, shells : mapping of str to Path
        Compiled libraries by FMI platform name.
    """

    model_name: str
    description: str
    version: str
    systems: Sequence[bytes]
    table: Sequence[Variable]
    rows: Sequence[Sequence[str]]
    stop_time: float
    step_size: float
    binding: Path
    kernels: Mapping[str, Path]
    shells: Mapping[str, Path]


def pack(contents: Contents, file: Path) -> str:
    """Write the FMU.

    Parameters
    ----------
    contents : Contents
    file : Path
        Where to; an older file is replaced only when the new one is whole.

    Returns
    -------
    str
        The GUID, a hash of all the content.
    """
    records = table_records(contents.table)
    entries = _package_files(contents)
    template = (_HERE / "main_template.py").read_text(encoding="utf-8")
    digest = hashlib.sha256(template.encode())
    for name in sorted(entries):
        digest.update(name.encode() + b"\0" + hashlib.sha256(entries[name]).digest())
    digest.update(
        json.dumps(
            [contents.model_name, contents.description, contents.version, contents.stop_time, records], sort_keys=True
        ).encode()
    )
    identity = digest.hexdigest()[:32]
    guid = f"{{{identity[:8]}-{identity[8:12]}-{identity[12:16]}-{identity[16:20]}-{identity[20:]}}}"

    # Names of their own per build: a host's Python keeps one module per name, whatever FMU it came from.
    package = f"ali3_{identity[:12]}"
    main = f"main_{identity[:12]}"
    script = template.replace("ModelName", contents.model_name).replace("PackageName", package)
    files = {f"resources/{package}/{name}": data for name, data in entries.items() if not name.startswith("binaries/")}
    files |= {name: data for name, data in entries.items() if name.startswith("binaries/")}
    files |= {
        f"resources/{main}.py": script.encode(),
        f"resources/{package}/fmu.json": json.dumps(
            {"identity": identity, "variables": records, "rows": [list(r) for r in contents.rows]}, indent=1
        ).encode(),
        "resources/slavemodule.txt": main.encode(),
        "resources/guid.txt": guid.encode(),
        "documentation/licenses/ALi3.txt": _license("ali3"),
        "documentation/licenses/PythonFMU.txt": _license("pythonfmu"),
        "documentation/index.html": _documentation(contents).encode(),
        "modelDescription.xml": model_description(
            Description(
                contents.model_name,
                contents.model_name,
                guid,
                contents.description,
                f"ALi3 {contents.version}, PythonFMU {pythonfmu.__version__}",
                contents.version,
                contents.stop_time,
                contents.step_size,
                needs_execution_tool=True,
            ),
            contents.table,
        ),
    }
    _write_zip(files, file)
    return guid


def _license(distribution: str) -> bytes:
    """The licence text an installed distribution carries."""
    files = importlib.metadata.files(distribution) or []
    texts = [Path(str(f.locate())).read_bytes() for f in files if f.name.upper().startswith("LICENSE")]
    if not texts:
        raise RuntimeError(f"The licence of '{distribution}' is not installed with it; install the package again.")
    return texts[0]


def _package_files(contents: Contents) -> dict[str, bytes]:
    """All files but those that carry the identity."""
    entries = {
        "__init__.py": b"",
        "slave.py": (_HERE / "slave.py").read_bytes(),
        "binding.py": contents.binding.read_bytes(),
        **{f"system_{k}.ali3": system for k, system in enumerate(contents.systems)},
        "pythonfmu/__init__.py": b"",
    }
    for module in _PYTHONFMU_MODULES:
        entries[f"pythonfmu/{module}.py"] = (_PYTHONFMU / f"{module}.py").read_bytes()
    for platform in contents.kernels:
        kernel = contents.kernels[platform]
        entries[f"{platform}/{kernel.name}"] = kernel.read_bytes()
        stem, suffix = f"binaries/{platform}/{contents.model_name}", SUFFIXES[platform]
        entries[stem + suffix] = contents.shells[platform].read_bytes()
        library = _PYTHONFMU / "resources" / "binaries" / platform / _PYTHONFMU_LIBRARY[platform]
        entries[f"{stem}-pythonfmu{suffix}"] = library.read_bytes()
    return entries


def _write_zip(files: Mapping[str, bytes], file: Path) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    partial = file.with_suffix(".part")
    # Stored, not deflated: the bytes do not depend on the version of a compression library.
    with zipfile.ZipFile(partial, "w", zipfile.ZIP_STORED) as archive:
        # The description first: readers that stream find it at once.
        for name in sorted(files, key=lambda n: (n != "modelDescription.xml", n)):
            info = zipfile.ZipInfo(name, _ZIP_DATE)
            info.create_system = 3
            info.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            archive.writestr(info, files[name])
    partial.replace(file)


def _documentation(contents: Contents) -> str:
    def cell(value: Any) -> str:
        return "" if value is None else html.escape(f"{value:g}" if isinstance(value, float) else str(value))

    columns = ("name", "causality", "variability", "unit", "start", "min", "max", "description")
    head = "".join(f"<th>{c}</th>" for c in columns)
    rows = "\n".join(
        "<tr>" + "".join(f"<td>{cell(getattr(v, c))}</td>" for c in columns) + "</tr>" for v in contents.table
    )
    name = html.escape(contents.model_name)
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{name}</title><style>'
        "body{font-family:sans-serif;margin:2em}td,th{padding:.2em .8em;text-align:left;border-bottom:1px solid #ddd}"
        f"</style></head>\n<body><h1>{name}</h1><p>{html.escape(contents.description)}</p>\n"
        f"<p>FMI 2.0 co-simulation, made by ALi3 {html.escape(contents.version)}. "
        f"Default step {contents.step_size:g} s. Inputs are held over a communication step; outputs belong to its end. "
        "A step that fails is refused (fmi2Discard) and the last good state is kept.</p>\n"
        f"<table><tr>{head}</tr>\n{rows}\n</table></body></html>\n"
    )
