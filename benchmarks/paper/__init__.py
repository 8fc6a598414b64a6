"""Tables and figures of the paper, computed with this engine."""
