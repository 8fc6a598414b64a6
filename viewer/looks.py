"""Colours and sizes of what is drawn, which the page reads too."""

import json
from pathlib import Path
from typing import Any

LOOKS: dict[str, Any] = json.loads(Path(__file__).with_name("looks.json").read_text(encoding="utf-8"))
