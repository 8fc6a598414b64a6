"""Recognises errors of lxml that are caused by lack of memory."""


def is_lack_of_memory(error: Exception) -> bool:
    """Whether an error of lxml is a failed allocation, which it reports without fault and line."""
    return str(error).startswith("unknown error") and getattr(error, "lineno", None) == 0
