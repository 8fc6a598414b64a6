"""``python -m hosts.soak``."""

import sys

from hosts.soak.command import main

sys.exit(main())
