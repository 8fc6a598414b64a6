"""Colours and other constants of drawings, shared with the page."""

import json
from pathlib import Path
from typing import Any

LOOKS: dict[str, Any] = json.loads(Path(__file__).with_name("looks.json").read_text(encoding="utf-8"))
