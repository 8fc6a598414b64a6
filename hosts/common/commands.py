"""Runs other commands of ali3 in a process of their own, so that hosts import neither the engine nor the builder."""

import subprocess
from collections.abc import Callable

from ali3.child_processes import how_ended
from ali3.message_text import brief
from ali3.processes import module_command
from hosts.common.errors import HostError

ERROR = "error: "


def run_ali3(*arguments: str, on_line: Callable[[str], None] = lambda line: None) -> str:
    """Run another command to its end. `on_line`: called with each line of its standard error.

    Result: its standard error; its standard output is dropped. Raises `HostError`: it did not succeed; with its
    message, or how its process ended.
    """
    if wrong := next((text for text in arguments if "\0" in text), None):
        raise HostError(f"{brief(wrong)} has a zero byte, which no name and no value may have.")
    lines: list[str] = []
    with subprocess.Popen(
        module_command("ali3", *arguments),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        encoding="utf-8",
        errors="replace",
    ) as process:
        assert process.stderr is not None
        try:
            for line in process.stderr:
                lines.append(line)
                on_line(line.strip())
        except BaseException:  # SIGTERM for this process alone: the other one would be waited for
            process.terminate()
            raise
    output = "".join(lines)
    if process.returncode != 0:
        last = output.strip().splitlines()[-1:]
        if last and last[0].startswith(ERROR):
            raise HostError(last[0].removeprefix(ERROR))
        raise HostError(f"The process of ali3 {how_ended(process.returncode, output)}.")
    return output
