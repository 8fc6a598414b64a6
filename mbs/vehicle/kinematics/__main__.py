"""``python -m mbs.vehicle.kinematics``."""

import sys

from mbs.vehicle.kinematics.command import main

sys.exit(main())
