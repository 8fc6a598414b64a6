"""Compiles C hosts for tests, and reads properties of binaries."""

import shutil
import struct
import subprocess
import sys
import zipfile
from pathlib import Path

import fmpy

from fmu_src.native.sources import HERE as FMI_HEADERS
from mbs.kernel import build
from tests import sanitize

ROOT = Path(__file__).parents[2]
C_FOLDER = Path(__file__).parent / "c"
LIBRARY_HEADERS = ROOT / "benchmarks" / "car" / "c"
HOST_SOURCE = ROOT / "hosts" / "c" / "host.c"
STANDARD_HEADERS = Path(fmpy.__file__).parent / "c-code"


def unpack(fmu: Path, folder: Path) -> Path:
    """Unpack an FMU."""
    with zipfile.ZipFile(fmu) as archive:
        archive.extractall(folder)
    return folder


def compile_host(folder: Path, target: str | None = None, source: Path = HOST_SOURCE) -> Path:
    """Compile the C host of the project, or another one, for a target of zig."""
    target = target or build.host_target()
    program = folder / (source.stem + (".exe" if "windows" in target else ""))
    # the project's host is for users: it has the headers of the standard and nothing else
    include = (STANDARD_HEADERS,) if source.parent == HOST_SOURCE.parent else (FMI_HEADERS, LIBRARY_HEADERS)
    build.compile_c([source], target, program, include=include, what="the C host", shared=False)
    return program


def compile_stress(fmu_folder: Path, program: Path, objects: Path) -> None:
    """Link `stress.c` with the FMU's own sources; with sanitizers where the system's gcc has them.

    `fmu_folder`: the unpacked FMU; `program`: the file to write; `objects`: folder of what gcc compiled, for the next
    FMU and the kernel of `tests.sanitize`.
    """
    sources = [C_FOLDER / "stress.c", *sorted((fmu_folder / "sources").rglob("*.c"))]
    include = f"-I{fmu_folder / 'sources'}"
    libraries = ["-lm", *([] if sys.platform == "win32" else ["-lpthread"])]
    gcc = shutil.which("gcc") if sys.platform == "linux" else None
    if gcc is not None and sanitize.runtimes("gcc"):
        command = ["gcc", *sanitize.FLAGS, *sanitize.ADDRESSES, *sanitize.UNDEFINED]
        object_files = sanitize.objects([*command, include], sources, objects)
        subprocess.run([*command, "-o", program, *object_files, *libraries], check=True)
        return
    flags = [*sanitize.FLAGS, *sanitize.UNDEFINED, "-fsanitize-trap=undefined"]
    command = [sys.executable, "-m", "ziglang", "cc", "-target", build.host_target(), *flags]
    subprocess.run([*command, include, "-o", str(program), *map(str, sources), *libraries], check=True)


def guid_of(folder: Path) -> str:
    """GUID of an unpacked FMU."""
    return str(fmpy.read_model_description(str(folder)).guid)


def elf_dynamic(data: bytes) -> tuple[list[str], set[str]]:
    """Needed libraries and exported names of a 64-bit little-endian ELF library."""
    (section_offset,) = struct.unpack_from("<Q", data, 40)
    size, count = struct.unpack_from("<2H", data, 58)
    sections = [struct.unpack_from("<2I4Q2I2Q", data, section_offset + k * size) for k in range(count)]

    def text(table: int, at: int) -> str:
        start = sections[table][4] + at
        return data[start : data.index(b"\0", start)].decode()

    needed: list[str] = []
    exported: set[str] = set()
    for _, kind, _, _, offset, length, link, _, _, entry in sections:
        if kind == 6:  # dynamic
            for k in range(length // entry):
                tag, value = struct.unpack_from("<2Q", data, offset + k * entry)
                if tag == 1:
                    needed.append(text(link, value))
        if kind == 11:  # dynamic symbols
            for k in range(1, length // entry):
                name, info, _, section, _, _ = struct.unpack_from("<I2BH2Q", data, offset + k * entry)
                if section != 0 and info >> 4 in (1, 2):
                    exported.add(text(link, name))
    return needed, exported


def pe_tables(data: bytes) -> tuple[list[str], set[str]]:
    """Imported libraries and exported names of a 64-bit Windows library."""
    (pe,) = struct.unpack_from("<I", data, 60)
    (count,) = struct.unpack_from("<H", data, pe + 6)
    (optional,) = struct.unpack_from("<H", data, pe + 20)
    sections = [struct.unpack_from("<8s4I", data, pe + 24 + optional + 40 * k) for k in range(count)]

    def at(address: int) -> int:
        for _, size, start, raw_size, raw in sections:
            if start <= address < start + max(size, raw_size):
                return int(raw + address - start)
        raise ValueError(f"address {address:#x} is in no section")

    def text(address: int) -> str:
        start = at(address)
        return data[start : data.index(b"\0", start)].decode()

    export, _, imports, _ = struct.unpack_from("<4I", data, pe + 24 + 112)
    libraries = []
    place = at(imports)
    while (entry := struct.unpack_from("<5I", data, place))[3]:
        libraries.append(text(entry[3]).lower())
        place += 20
    n_names, _, names = struct.unpack_from("<3I", data, at(export) + 24)
    exported = {text(struct.unpack_from("<I", data, at(names) + 4 * k)[0]) for k in range(n_names)}
    return libraries, exported
