"""Compiles an FMU for more platforms from the sources that lie in it: no model is needed."""

from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree

from ali3.archives import Archive
from ali3.errors import UserError
from ali3.reading import is_file, missing_file_text
from ali3.temporary_folder import temporary_folder
from fmu_src.native.archive import write_zip
from fmu_src.native.compilation import compile_library, compile_packed
from fmu_src.native.package import StageReport, first_time
from fmu_src.native.platforms import SUFFIXES, TARGETS
from fmu_src.native.sources import packed_sources
from mbs.compiler.generated.source import TABLE

_SOURCES = ("sources/table.c", "sources/fmi2_direct.c", "sources/fmi2_alone.c")


def add_platforms(fmu: Path, platforms: Sequence[str], file: Path, report_stage: StageReport) -> list[str]:
    """Write an FMU again with binaries for more platforms; all else stays, its GUID too.

    Parameters
    ----------
    fmu : Path
        Of the kind ``native``.
    platforms : sequence of str
        Out of `fmu_src.native.platforms.TARGETS`; what is there already is kept.
    file : Path
        Where to; may be `fmu` itself.
    report_stage : callable
        ``report_stage(what, note)`` makes a context in which `what` is done.

    Raises
    ------
    ali3.errors.UserError
        The file is not an FMU of the kind ``native``.
    """
    files = _files(fmu)
    name = _identifier(fmu, files)
    if any(source not in files for source in _SOURCES):
        raise UserError(f"{fmu} is not an FMU of ALi3 of the kind native (FMI 2.0 in C); only these can be recompiled.")
    added = [p for p in platforms if f"binaries/{p}/{name}{SUFFIXES[p]}" not in files]
    with temporary_folder() as folder:
        for platform in added:
            library = name + SUFFIXES[platform]
            with report_stage(f"compiling for {platform}", first_time(platform)):
                binary = _compile(files, TARGETS[platform], Path(folder, platform), library)
            files[f"binaries/{platform}/{library}"] = binary
    write_zip(files, file)
    return added


def _files(fmu: Path) -> dict[str, bytes]:
    if not is_file(fmu):
        raise UserError(missing_file_text(fmu))
    with Archive(fmu, UserError, kind="an FMU") as archive:
        return {name: archive.read(name) for name in archive.names}


def _identifier(fmu: Path, files: dict[str, bytes]) -> str:
    """Model identifier, the name of the libraries."""
    try:
        face = ElementTree.fromstring(files["modelDescription.xml"]).find("CoSimulation")
    except (KeyError, ElementTree.ParseError):
        raise UserError(f"{fmu} is not an FMU: it has no modelDescription.xml that can be read.") from None
    if face is None or not face.get("modelIdentifier", "").isidentifier():
        raise UserError(f"{fmu} is not an FMU for co-simulation.")
    return str(face.get("modelIdentifier"))


def _compile(files: dict[str, bytes], targets: Sequence[str], folder: Path, library: str) -> bytes:
    """The library; from the installed sources if the FMU has the same, since the compiler has kept their objects."""
    sources = {name.removeprefix("sources/"): data for name, data in files.items() if name.startswith("sources/")}
    for path, data in sources.items():
        (folder / "sources" / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / "sources" / path).write_bytes(data)
    table = folder / "sources" / "table.c"
    generated = {p.removesuffix(".c"): data.decode() for p, data in sources.items() if p.startswith(f"{TABLE}_")}
    if sources == packed_sources("fmi2", sources["table.c"].decode(), generated):
        return compile_library(targets, "fmi2", table, generated, folder, library)
    return compile_packed(targets, folder / "sources", folder, library)
