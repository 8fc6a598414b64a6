"""The tables of docs/systems.md: python -m tests.hosts.systems.tables [PICTURE]"""

from __future__ import annotations

import sys

from tests.hosts.systems import controlled, weak_coupling

if __name__ == "__main__":
    weak_coupling.main(*sys.argv[1:])
    print()
    controlled.main()
