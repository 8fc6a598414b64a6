"""Checks of an FMU that need no run: description, binaries, units, features that tools may use."""

import ctypes
from xml.etree import ElementTree

from fmpy import platform, platform_tuple, sharedLibraryExtension, supported_platforms
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu

from ali3.call_mark import marked
from ali3.columns import some_of
from ali3.processes import cause_text
from hosts.check.instance import REAL, Check, Finding, Subject

FUNCTIONS = "functions"


def description(subject: Subject) -> Finding:
    """FMPy's validation: schema, names, start values, structure."""
    problems = validate_fmu(str(subject.path))
    if problems:
        return Finding("model description", "bad", f"{len(problems)} problems, the first: {problems[0]}")
    count = len(subject.description.modelVariables)
    return Finding("model description", "good", f"FMI {subject.description.fmiVersion}, {count} variables")


def binaries(subject: Subject) -> Finding:
    """Whether there is a binary for this machine."""
    platforms = supported_platforms(str(subject.path))
    message = ", ".join(platforms) or "none"
    return Finding("binaries", "good" if platform in platforms else "bad", message)


def functions(subject: Subject) -> Finding:
    """Whether the library can be loaded and has all functions of the standard, under their names."""
    face = subject.description.coSimulation.modelIdentifier
    library = (
        subject.folder
        / "binaries"
        / (platform_tuple if subject.three else platform)
        / f"{face}{sharedLibraryExtension}"
    )

    def lacks(message: str) -> Finding:
        return Finding(FUNCTIONS, "bad", message, last=True)

    try:
        loaded = marked("dlopen", ctypes.CDLL)(str(library))
    except OSError as error:
        return lacks(f"the library cannot be loaded: {error}{cause_text(error)}")
    kind, prefix = (FMU3Slave, "fmi3") if subject.three else (FMU2Slave, "fmi2")
    names = [name for name in dir(kind) if name.startswith(prefix)]
    missing = [name for name in names if not hasattr(loaded, name)]
    if not missing:
        return Finding(FUNCTIONS, "good", f"the library has all {len(names)}")
    if hasattr(loaded, f"{face}_{missing[0]}"):
        return lacks(
            f"they begin with the prefix {face}_, which those of sources and static libraries have, not those of a "
            f"shared library {subject.clause('2.1.1', '2.2.2')}",
        )
    return lacks(f"{len(missing)} of {len(names)} are missing: {some_of(missing)} {subject.clause('2.3', '2.5')}")


def execution_tool(subject: Subject) -> Finding:
    """Whether the FMU needs no execution tool."""
    if subject.description.coSimulation.needsExecutionTool:
        return Finding("stands alone", "note", "needs another program on the machine that runs it")
    return Finding("stands alone", "good", "needs no other program")


def size(subject: Subject) -> Finding:
    """The size of the file of the FMU."""
    return Finding("size", "good", f"{subject.path.stat().st_size / 1e6:.2f} MB")


def units(subject: Subject) -> Finding:
    """Variables without a unit."""
    bare = [
        v.name
        for v in subject.description.modelVariables
        if v.type in REAL
        and v.causality in ("input", "output", "parameter")
        and not v.unit
        and not (v.declaredType is not None and v.declaredType.unit)
    ]
    if bare:
        return Finding("units", "note", f"{len(bare)} variables have none, such as {bare[0]}")
    return Finding("units", "good", "every real variable has one")


def folders(subject: Subject) -> Finding:
    """Documentation, sources and licence."""
    names = {
        "documentation": subject.folder / "documentation" / "index.html",
        "sources": subject.folder / "sources",
        "licence": subject.folder / "documentation" / "licenses",
    }
    missing = [name for name, path in names.items() if not path.exists()]
    if missing:
        return Finding("documentation, sources", "note", f"missing: {', '.join(missing)}")
    return Finding("documentation, sources", "good", "documentation, sources and licence are inside")


def source_files(subject: Subject) -> Finding:
    """Source files that the documents name are there."""
    sources = subject.folder / "sources"
    file_names = [] if subject.face is None else [e.get("name", "") for e in subject.face.iter("File")]
    if (build := sources / "buildDescription.xml").exists():
        file_names += [e.get("name", "") for e in ElementTree.parse(build).getroot().iter("SourceFile")]
    missing = [name for name in file_names if not (sources / name).is_file()]
    if missing:
        message = (
            f"{len(missing)} of {len(file_names)} that are named are missing: {some_of(missing)}; pack them in sources"
        )
        return Finding("source files", "bad", f"{message} {subject.clause('2.3', '2.5.1')}")
    return Finding("source files", "good", f"all {len(file_names)} that are named are there")


DOCUMENT_CHECKS = (
    Check("model description", description, calls=False),
    Check("binaries", binaries, calls=False),
    Check(FUNCTIONS, functions, calls=False),
    Check("stands alone", execution_tool, calls=False),
    Check("size", size, calls=False),
    Check("units", units, calls=False),
    Check("documentation, sources", folders, calls=False),
    Check("source files", source_files, calls=False),
)
