"""The console command as a module: ``python -m ali3``."""

import sys

from ali3.search_path import forget_current_folder


def _main() -> int:
    forget_current_folder()
    from ali3.command import main

    return main(prog="python -m ali3")


if __name__ == "__main__":
    sys.exit(_main())
