"""Checks of an FMU that need no run: documents, binaries, units, what a tool could want."""

from __future__ import annotations

from fmpy import platform, supported_platforms
from fmpy.validation import validate_fmu

from hosts.check.instance import Finding, Subject


def description(subject: Subject) -> Finding:
    """FMPy's validation: schema, names, start values, structure."""
    problems = validate_fmu(str(subject.path))
    if problems:
        return Finding("model description", "bad", f"{len(problems)} problems, the first: {problems[0]}")
    count = len(subject.description.modelVariables)
    return Finding("model description", "good", f"FMI {subject.description.fmiVersion}, {count} variables")


def binaries(subject: Subject) -> Finding:
    """Whether there is a binary for this machine."""
    found = supported_platforms(str(subject.path))
    words = ", ".join(found) or "none"
    return Finding("binaries", "good" if platform in found else "bad", words)


def execution_tool(subject: Subject) -> Finding:
    """Whether the FMU stands alone."""
    if subject.description.coSimulation.needsExecutionTool:
        return Finding("stands alone", "note", "needs another program on the machine that runs it")
    return Finding("stands alone", "good", "needs no other program")


def size(subject: Subject) -> Finding:
    """Size of the file."""
    return Finding("size", "good", f"{subject.path.stat().st_size / 1e6:.2f} MB")


def units(subject: Subject) -> Finding:
    """Variables without a unit."""
    bare = [
        v.name
        for v in subject.description.modelVariables
        if v.type in ("Real", "Float64")
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


DOCUMENT_CHECKS = (
    ("model description", description),
    ("binaries", binaries),
    ("stands alone", execution_tool),
    ("size", size),
    ("units", units),
    ("documentation, sources", folders),
)
