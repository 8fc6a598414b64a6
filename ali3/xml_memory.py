"""Recognises errors of lxml that mean that memory was not enough."""


def is_lack_of_memory(error: Exception) -> bool:
    """Whether a failed reading of XML is a failed allocation: lxml knows neither the fault nor the line then."""
    return str(error).startswith("unknown error") and getattr(error, "lineno", None) == 0
