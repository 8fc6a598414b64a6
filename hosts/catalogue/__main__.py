"""``python -m hosts.catalogue``."""

import sys

from hosts.catalogue.command import main

sys.exit(main())
