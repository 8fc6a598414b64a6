"""The console command, also as a module: ``python -m ali3``."""

import sys

from ali3.search_path import forget_current_folder


def main(prog: str = "ali3") -> int:
    """Run the command that the user typed as `prog`; Ctrl-C while its modules are imported ends it as later."""
    forget_current_folder()
    try:
        from ali3.command import main as run

        return run(prog=prog)
    except KeyboardInterrupt:
        print("stopped by Ctrl-C", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main("python -m ali3"))
