"""``python -m hosts.compare``."""

import sys

from hosts.compare.command import main

sys.exit(main())
