"""The console command ``ali3``, which runs one of its subcommands."""

import argparse
import importlib
import sys
from collections.abc import Sequence

from ali3.command_run import WRONG_USE, run_command
from ali3.commands import COMMANDS, Command
from ali3.extras import command_needs
from ali3.message_text import brief
from ali3.near_names import did_you_mean
from ali3.options import Parser
from ali3.processes import store_typed_name


def main(arguments: Sequence[str] | None = None, prog: str = "ali3") -> int:
    """Run the subcommand that the first argument names.

    `arguments`: by default `sys.argv[1:]`; `prog`: how the user typed the command. Returns the exit code of
    `ali3.command_run`.
    """
    words = list(sys.argv[1:] if arguments is None else arguments)
    store_typed_name(prog)
    if words and not words[0].startswith("-"):
        command = next((c for c in COMMANDS if c.name == words[0]), None)
        if command is None:
            return _report_unknown(words[0], prog)
        return run_command(lambda: _run_subcommand(command, words[1:], prog))
    return run_command(lambda: _print_help(words, prog))


def _run_subcommand(command: Command, arguments: Sequence[str], prog: str) -> int:
    """Import the module of a subcommand and run it."""
    command_needs(command.extra)
    module = importlib.import_module(command.module)
    return int(module.main(arguments, f"{prog} {command.name}"))


def _print_help(arguments: Sequence[str], prog: str) -> int:
    """Print the help after a call without a subcommand."""
    parser = _make_parser(prog)
    parser.parse_args(arguments)  # handles --help and --version, refuses other options
    parser.print_help(sys.stderr)
    return WRONG_USE


def _make_parser(prog: str) -> argparse.ArgumentParser:
    width = max(len(c.name) for c in COMMANDS)
    parser = Parser(
        prog=prog,
        usage=f"{prog} COMMAND [...]",
        description="Real-time multibody dynamics: from a model to an FMU, and programs that run it.",
        epilog="commands:\n"
        + "\n".join(f"  {c.name:<{width}}  {c.summary}" for c in COMMANDS)
        + f"\n\n{prog} COMMAND --help describes a command.",
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version and stop")
    return parser


class _Version(argparse.Action):
    """Prints the version; it is read only here because reading takes longer than printing the help."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from importlib.metadata import version

        parser.exit(message=f"ali3 {version('ali3')}\n")


def _report_unknown(name: str, prog: str) -> int:
    """Report an unknown subcommand."""
    names = [c.name for c in COMMANDS]
    hint = did_you_mean(name, names, f"the commands are {', '.join(names)}", most=1)
    print(f"error: There is no command {brief(name)}{hint} {prog} --help describes them.", file=sys.stderr)
    return WRONG_USE
