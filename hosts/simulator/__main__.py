"""``python -m hosts.simulator``."""

from __future__ import annotations

import sys

from hosts.simulator.command import main

if __name__ == "__main__":  # the process of the car imports this module too
    sys.exit(main())
