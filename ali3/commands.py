"""The subcommands of ali3: name, module, the extra that each needs, and its line in the help."""

from typing import NamedTuple


class Command(NamedTuple):
    """A subcommand of ali3."""

    name: str
    """Word that the user types."""
    module: str
    """Imported when the command runs; its ``main(arguments, prog)`` returns the exit code."""
    extra: str
    """Extra of the package ``ali3`` that the command needs; empty if none."""
    summary: str
    """Line in the help of ``ali3``."""


COMMANDS = (
    Command("build", "fmu_src.build.command", "fmu", "build the FMUs of a car or a scene, or the C kernel"),
    Command(
        "car",
        "mbs.vehicle.command",
        "",
        "copy a car, check a car file, draw the kinematics of its axles, or find its cheapest sufficient fidelity",
    ),
    Command(
        "run", "hosts.run.command", "hosts", "run an FMU or drive a car through a manoeuvre; tables and charts of it"
    ),
    Command(
        "view",
        "hosts.view.command",
        "hosts",
        "animate a result or an FMU in a page, or run an FMU live in it; pictures, films",
    ),
    Command(
        "simulator",
        "hosts.simulator.command",
        "simulator",
        "drive a car in real time, from a page or by a steering wheel; repeat recordings",
    ),
    Command(
        "check",
        "hosts.check.command",
        "hosts",
        "check an FMU, compare it with a reference, show its parameters, or drive it for hours",
    ),
    Command(
        "catalogue",
        "hosts.catalogue.command",
        "hosts",
        "run standard tests with cars side by side and report their measures",
    ),
    Command(
        "compare", "hosts.compare.command", "study", "compare an FMU with a log of a test drive, and fit parameters"
    ),
    Command(
        "study",
        "hosts.study.command",
        "study",
        "drive many variants of a car or another FMU, on one machine or a cluster",
    ),
    Command("road", "mbs.worlds.command", "", "make, check and show road files and worlds to drive in"),
)
