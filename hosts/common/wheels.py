"""Names of the four wheels in those of variables, front left first."""

WHEELS = ("FL", "FR", "RL", "RR")
