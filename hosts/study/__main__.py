"""``python -m hosts.study``."""

import sys

from hosts.study.command import main

if __name__ == "__main__":  # a worker of a cluster imports it under another name
    sys.exit(main())
