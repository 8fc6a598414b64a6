"""Checks of an FMU that need no run: archive, description, binaries, units, features that tools may use."""

import ctypes
from pathlib import Path
from xml.etree import ElementTree

from fmpy import platform, platform_tuple, sharedLibraryExtension, supported_platforms
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu

from ali3.archives import faults_of
from ali3.call_mark import marked
from ali3.columns import some_of
from ali3.processes import cause_text
from ali3.reading import is_file, missing_file_text
from hosts.check.instance import REAL, Finding, Subject, check
from hosts.common.errors import HostError

FUNCTIONS = "functions"
ARCHIVE = "archive"


@check("model description", calls=False)
def check_description(subject: Subject) -> Finding:
    """Whether FMPy finds the description valid: schema, names, start values, structure."""
    problems = validate_fmu(str(subject.path))
    if problems:
        return Finding("bad", f"{len(problems)} problems, the first: {problems[0]}")
    count = len(subject.description.modelVariables)
    return Finding("good", f"FMI {subject.description.fmiVersion}, {count} variables")


@check("binaries", calls=False)
def check_binaries(subject: Subject) -> Finding:
    """Whether the FMU has a binary for this platform."""
    platforms = supported_platforms(str(subject.path))
    message = ", ".join(platforms) or "none"
    return Finding("good" if platform in platforms else "bad", message)


@check(FUNCTIONS, calls=False)
def check_functions(subject: Subject) -> Finding:
    """Whether the library can be loaded and has all functions of the standard, under their names."""
    model = subject.description.coSimulation.modelIdentifier
    library = (
        subject.folder
        / "binaries"
        / (platform_tuple if subject.is_fmi3 else platform)
        / f"{model}{sharedLibraryExtension}"
    )

    def bad_finding(message: str) -> Finding:
        return Finding("bad", message, last=True)

    try:
        loaded_library = marked("dlopen", ctypes.CDLL)(str(library))
    except OSError as error:
        return bad_finding(f"the library cannot be loaded: {error}{cause_text(error)}")
    slave_class, prefix = (FMU3Slave, "fmi3") if subject.is_fmi3 else (FMU2Slave, "fmi2")
    names = [name for name in dir(slave_class) if name.startswith(prefix)]
    missing = [name for name in names if not hasattr(loaded_library, name)]
    if not missing:
        return Finding("good", f"the library has all {len(names)}")
    if hasattr(loaded_library, f"{model}_{missing[0]}"):
        return bad_finding(
            f"they begin with the prefix {model}_, which those of sources and static libraries have, not those of a "
            f"shared library {subject.clause('2.1.1', '2.2.2')}"
        )
    return bad_finding(f"{len(missing)} of {len(names)} are missing: {some_of(missing)} {subject.clause('2.3', '2.5')}")


@check("stands alone", calls=False)
def check_execution_tool(subject: Subject) -> Finding:
    """Whether the FMU needs no execution tool."""
    if subject.description.coSimulation.needsExecutionTool:
        return Finding("note", "needs another program on the machine that runs it")
    return Finding("good", "needs no other program")


@check("size", calls=False)
def check_size(subject: Subject) -> Finding:
    """The file size of the FMU."""
    return Finding("good", f"{subject.path.stat().st_size / 1e6:.2f} MB")


@check("units", calls=False)
def check_units(subject: Subject) -> Finding:
    """Whether all real inputs, outputs and parameters have a unit."""
    without_unit = [
        v.name
        for v in subject.description.modelVariables
        if v.type in REAL
        and v.causality in ("input", "output", "parameter")
        and not v.unit
        and not (v.declaredType is not None and v.declaredType.unit)
    ]
    if without_unit:
        return Finding("note", f"{len(without_unit)} variables have none, such as {without_unit[0]}")
    return Finding("good", "every real variable has one")


@check("documentation, sources", calls=False)
def check_folders(subject: Subject) -> Finding:
    """Whether documentation, sources and licence are in the FMU."""
    names = {
        "documentation": subject.folder / "documentation" / "index.html",
        "sources": subject.folder / "sources",
        "licence": subject.folder / "documentation" / "licenses",
    }
    missing = [name for name, path in names.items() if not path.exists()]
    if missing:
        return Finding("note", f"missing: {', '.join(missing)}")
    return Finding("good", "documentation, sources and licence are inside")


@check("source files", calls=False)
def check_source_files(subject: Subject) -> Finding:
    """Whether the source files that the documents name are in the FMU."""
    sources = subject.folder / "sources"
    file_names = (
        []
        if subject.co_simulation_element is None
        else [e.get("name", "") for e in subject.co_simulation_element.iter("File")]
    )
    if (build := sources / "buildDescription.xml").exists():
        file_names += [e.get("name", "") for e in ElementTree.parse(build).getroot().iter("SourceFile")]
    missing = [name for name in file_names if not (sources / name).is_file()]
    if missing:
        message = (
            f"{len(missing)} of {len(file_names)} that are named are missing: {some_of(missing)}; pack them in sources"
        )
        return Finding("bad", f"{message} {subject.clause('2.3', '2.5.1')}")
    return Finding("good", f"all {len(file_names)} that are named are there")


def check_archive(fmu: Path) -> list[Finding]:
    """Find what prevents an FMU from being unpacked: bad if a standard forbids it, otherwise a note.

    Raises `HostError` if the file is not a readable archive.
    """
    if not is_file(fmu):
        raise HostError(missing_file_text(fmu))
    return [
        Finding("bad", f"{fault.words} ({fault.clause})") if fault.clause else Finding("note", fault.words)
        for fault in faults_of(fmu, HostError, "an FMU")
    ]
