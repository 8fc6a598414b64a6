"""Formats values as command-line arguments, for commands that repeat a run."""

from collections.abc import Mapping

from hosts.common.numbers import Value, text_of


def set_arguments(values: Mapping[str, Value]) -> list[str]:
    """Words of a command line that set these values by ``--set``."""
    texts = {name: value if isinstance(value, str) else text_of(value) for name, value in values.items()}
    return [word for name, text in texts.items() for word in ("--set", f"{name}={text}")]
