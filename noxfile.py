"""The tests with every supported Python, and with the oldest packages that pyproject.toml admits.

``nox`` runs every line of the table; ``nox -s lowest -- tests/hosts`` one line, a part of the tests. An
interpreter that is not found is skipped, which nox says at the end.
"""

import nox

TABLE = {
    "newest": ("3.11", "3.12", "3.13", "3.14", "3.15"),  # each with the newest packages
    "lowest": ("3.11",),  # with the lowest versions that pyproject.toml names, and the newest of what those need
}

nox.needs_version = ">=2024.10"
nox.options.error_on_missing_interpreters = False
nox.options.default_venv_backend = "uv"


@nox.session(python=TABLE["newest"])
def newest(session: nox.Session) -> None:
    """The newest packages."""
    tests(session, "highest")


@nox.session(python=TABLE["lowest"])
def lowest(session: nox.Session) -> None:
    """The lowest versions that pyproject.toml admits."""
    tests(session, "lowest-direct")


def tests(session: nox.Session, resolution: str) -> None:
    """Install and run the tests, or the part of them that the arguments after ``--`` choose."""
    session.install("--resolution", resolution, "-e", ".[fem,pictures,test]")
    session.run("python", "-m", "ali3", "--version")
    session.run("python", "-m", "pytest", "-n", "auto", "-m", "not proof", *session.posargs)
