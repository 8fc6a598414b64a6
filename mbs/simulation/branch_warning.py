"""Warning about a closed loop that changed its assembly mode."""


class BranchWarning(UserWarning):
    """A closed loop changed its assembly mode; the message names the loop, the time and a remedy."""
