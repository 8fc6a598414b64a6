"""Packs a System, the kernel, the slave and PythonFMU into an FMU: the same content gives the same bytes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import pythonfmu

from fmu_src.archive import identity_of, licence, write_zip
from fmu_src.description import model_description
from fmu_src.documentation import documentation
from fmu_src.native.package import NativeContents
from fmu_src.platforms import SUFFIXES
from fmu_src.variables import table_records
from mbs.kernel import binding, header

_HERE = Path(__file__).parent
_PYTHONFMU = Path(pythonfmu.__file__).parent
_PYTHONFMU_MODULES = ("_version", "default_experiment", "enums", "fmi2slave", "logmsg", "variables")
_PYTHONFMU_LIBRARY = {"linux64": "libpythonfmu-export.so", "win64": "pythonfmu-export.dll"}


def pack(contents: NativeContents, kernels: Mapping[str, Path], shells: Mapping[str, Path], file: Path) -> str:
    """Write the FMU.

    Parameters
    ----------
    contents : NativeContents
        The same as for the native kinds.
    kernels, shells : mapping of str to Path
        Compiled libraries by FMI platform name.
    file : Path
        Where to; an older file is replaced only when the new one is whole.

    Returns
    -------
    str
        The GUID, a hash of all the content.
    """
    records = table_records(contents.table)
    entries = _package_files(contents, kernels, shells)
    template = (_HERE / "main_template.py").read_text(encoding="utf-8")
    identity, guid = identity_of(
        entries | {"main": template.encode()},
        [
            *(contents.model_name, contents.description, contents.version, contents.stop_time, records),
            *(contents.author, contents.copyright, contents.licence),
        ],
    )

    # Names of their own per build: a host's Python keeps one module per name, whatever FMU it came from.
    package = f"ali3_{identity[:12]}"
    main = f"main_{identity[:12]}"
    script = template.replace("ModelName", contents.model_name).replace("PackageName", package)
    files = {f"resources/{package}/{name}": data for name, data in entries.items() if not name.startswith("binaries/")}
    files |= {name: data for name, data in entries.items() if name.startswith("binaries/")}
    files |= {
        f"resources/{main}.py": script.encode(),
        f"resources/{package}/fmu.json": json.dumps(
            {"identity": identity, "variables": records, "rows": contents.rows}, indent=1
        ).encode(),
        "resources/slavemodule.txt": main.encode(),
        "resources/guid.txt": guid.encode(),
        "documentation/licenses/license.txt": licence("ali3"),
        "documentation/licenses/PythonFMU.txt": licence("pythonfmu"),
        "documentation/index.html": documentation(
            contents.model_name,
            contents.description,
            contents.version,
            contents.step_size,
            contents.table,
            ["FMI 2.0 co-simulation in Python: the host's machine needs Python 3.10 or newer."],
        ).encode(),
        "modelDescription.xml": model_description(
            contents.description_head(
                guid, tool=f"ALi3 {contents.version}, PythonFMU {pythonfmu.__version__}", needs_execution_tool=True
            ),
            contents.table,
            contents.reach,
        ),
    }
    write_zip(files, file)
    return guid


def _package_files(
    contents: NativeContents, kernels: Mapping[str, Path], shells: Mapping[str, Path]
) -> dict[str, bytes]:
    """All files but those that carry the identity."""
    entries = {
        "__init__.py": b"",
        "slave.py": (_HERE / "slave.py").read_bytes(),
        "header.py": Path(header.__file__).read_bytes(),
        **{f"binding/{f.name}": f.read_bytes() for f in sorted(Path(binding.__file__).parent.glob("*.py"))},
        **{f"system_{k}.ali3": system.to_bytes() for k, system in enumerate(contents.systems)},
        "pythonfmu/__init__.py": b"",
    }
    for module in _PYTHONFMU_MODULES:
        entries[f"pythonfmu/{module}.py"] = (_PYTHONFMU / f"{module}.py").read_bytes()
    for platform, kernel in kernels.items():
        entries[f"{platform}/{kernel.name}"] = kernel.read_bytes()
        stem, suffix = f"binaries/{platform}/{contents.model_name}", SUFFIXES[platform]
        entries[stem + suffix] = shells[platform].read_bytes()
        library = _PYTHONFMU / "resources" / "binaries" / platform / _PYTHONFMU_LIBRARY[platform]
        entries[f"{stem}-pythonfmu{suffix}"] = library.read_bytes()
    return entries
