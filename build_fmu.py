"""Builds the FMUs of a scene in a clone: ``python build_fmu.py`` is ``ali3 build``."""

import sys

from fmu_src.build.command import main

if __name__ == "__main__":
    sys.exit(main())
