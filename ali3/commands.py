"""The subcommands of ali3: name, module, the extra that it needs."""

from __future__ import annotations

from typing import NamedTuple


class Command(NamedTuple):
    """A subcommand.

    Parameters
    ----------
    name : str
        As the user types it.
    module : str
        Imported when the command runs; its ``main(arguments, prog)`` returns the exit code.
    extra : str
        Of the installation, which brings the packages of the command; empty if it needs none.
    text : str
        One line of help.
    """

    name: str
    module: str
    extra: str
    text: str


COMMANDS = (
    Command("build", "fmu_src.build.command", "fmu", "build the FMUs of a car or a scene"),
    Command("car", "mbs.vehicle.command", "", "copy a car of the package to a folder, or check a car file"),
    Command("drive", "hosts.run.drive", "hosts", "drive the FMU of a car through a manoeuvre"),
    Command("run", "hosts.run.run", "hosts", "run any FMU with constant inputs and plot its outputs"),
    Command(
        "view", "hosts.view.view", "hosts", "show a result or an FMU moving, in a page; pictures, films and glTF of it"
    ),
    Command("page", "hosts.view.page", "hosts", "write a page that runs an FMU in a browser"),
    Command(
        "simulator",
        "hosts.simulator.command",
        "simulator",
        "drive an FMU in real time, from a page or by a steering wheel",
    ),
    Command(
        "parameters", "hosts.fmu.parameters", "hosts", "show the parameters of an FMU, or write them as a parameter set"
    ),
    Command("check", "hosts.check.command", "hosts", "check an FMU and print a verdict"),
    Command(
        "catalogue",
        "hosts.catalogue.command",
        "hosts",
        "do standard tests with cars side by side and report their measures",
    ),
    Command(
        "study",
        "hosts.study.command",
        "study",
        "drive many variants of a car or another FMU, on one machine or a cluster",
    ),
    Command(
        "compare", "hosts.compare.command", "study", "hold an FMU against a log of a test drive, and fit parameters"
    ),
    Command("kinematics", "mbs.vehicle.kinematics.command", "hosts", "draw the wheel travel and steer curves of a car"),
    Command("kerb", "hosts.run.kerb", "hosts", "run the paper's kerb test and draw the moments of the frame"),
    Command(
        "recording",
        "hosts.recordings.command",
        "simulator",
        "say what a recording of the simulator holds; repeat it, or make a manoeuvre of it",
    ),
    Command("road", "mbs.worlds.road_command", "", "make, check and show road files"),
    Command("soak", "hosts.soak.command", "simulator", "drive a car for hours by itself, and check every step"),
    Command("world", "mbs.worlds.command", "", "make the road file and the drawing of a world to drive in"),
    Command("kernel", "mbs.kernel.build", "fmu", "compile the C kernel for a platform"),
)
