"""Pieces of one HTML file that needs nothing else."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Sequence
from html import escape

STYLE = """
:root { color-scheme: light; }
body { font: 15px/1.45 "DejaVu Sans", Verdana, sans-serif; color: #222; margin: 2rem auto; max-width: 1180px;
  padding: 0 1rem; }
h1 { font-size: 1.6rem; margin-bottom: .2rem; } h2 { font-size: 1.25rem; margin-top: 2.4rem; border-top: 1px solid #ddd;
  padding-top: 1rem; } h3 { font-size: 1rem; margin: 1.2rem 0 .4rem; }
table { border-collapse: collapse; font-size: .85rem; } td, th { padding: .2rem .6rem; text-align: right;
  border-bottom: 1px solid #e3e3e3; vertical-align: top; } th { color: #555; font-weight: 600; }
td:first-child, th:first-child, td.text, th.text { text-align: left; }
code { font: .78rem "DejaVu Sans Mono", monospace; background: #f4f4f4; padding: .05rem .3rem; white-space: pre-wrap;
  overflow-wrap: anywhere; user-select: all; }
img { max-width: 100%; } p.note { color: #555; font-size: .85rem; } p.warning { border-left: 4px solid #D55E00;
  padding-left: .8rem; } .scroll { overflow-x: auto; } nav a { margin-right: 1rem; }
"""


def document(title: str, body: Iterable[str]) -> str:
    """The whole file."""
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{escape(title)}</title>\n'
        f"<style>{STYLE}</style>\n</head>\n<body>\n" + "\n".join(body) + "\n</body>\n</html>\n"
    )


def paragraph(text: str, kind: str = "") -> str:
    """A paragraph; kind ``note`` or ``warning``."""
    return f'<p class="{kind}">{escape(text)}</p>' if kind else f"<p>{escape(text)}</p>"


def table(head: Sequence[str], rows: Iterable[Sequence[str]], text_columns: Sequence[int] = (0,)) -> str:
    """A table; cells that begin with ``<code>`` are HTML already."""
    lines = [_row(head, "th", text_columns), *(_row(row, "td", text_columns) for row in rows)]
    return '<div class="scroll"><table>' + "\n".join(lines) + "</table></div>"


def code(text: str) -> str:
    """A command to be copied."""
    return f"<code>{escape(text)}</code>"


def picture(png: bytes, what: str) -> str:
    """An image within the file."""
    return f'<img alt="{escape(what, quote=True)}" src="data:image/png;base64,{base64.b64encode(png).decode()}">'


def _row(cells: Sequence[str], tag: str, text_columns: Sequence[int]) -> str:
    made = []
    for k, cell in enumerate(cells):
        kind = ' class="text"' if k in text_columns else ""
        made.append(f"<{tag}{kind}>{cell if cell.startswith('<code>') else escape(cell)}</{tag}>")
    return f"<tr>{''.join(made)}</tr>"
