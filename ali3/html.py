"""Writes HTML pages as one file that runs no other scripts than its own; reports share the style ``report.css``."""

import base64
import hashlib
import html
from collections.abc import Mapping, Sequence
from importlib.resources import files


def page(
    title: str,
    body: str,
    style: str = "",
    head: str = "",
    scripts: Sequence[str] = (),
    sources: Mapping[str, str] | None = None,
) -> str:
    """A complete HTML page as text.

    Its content security policy allows only embedded pictures, this style and these scripts, identified by their
    SHA-256. Markup that a text has injected into the body can thus not run, load or send anything.

    Parameters
    ----------
    body : str
        Markup, in which texts are escaped.
    style : str, optional
        CSS.
    head : str, optional
        More markup of the head.
    scripts : sequence of str, optional
        JavaScript, at the end of the body.
    sources : mapping of str to str, optional
        Further sources that the policy allows, by directive, such as ``{"connect-src": "'self'"}``.

    Raises
    ------
    ValueError
        A script or the style has characters that would end its element or change its hash.
    """
    for text, end in [(style, "</style"), *((script, "</script") for script in scripts)]:
        if end in text.lower() or "<!--" in text or "\r" in text or "\0" in text:
            raise ValueError(
                f"A script or style of the page '{title}' holds {end}, <!--, a carriage return or a NUL character."
            )
    directives = {
        "default-src": "'none'",
        "script-src": " ".join(map(_hash, scripts)) or "'none'",
        "style-src": _hash(style) if style else "'none'",
        "img-src": "data:",
        "base-uri": "'none'",
        "form-action": "'none'",
    }
    for directive, added_sources in (sources or {}).items():
        directives[directive] = f"{directives.get(directive, '')} {added_sources}".removeprefix("'none' ").strip()
    policy = "; ".join(f"{directive} {value}" for directive, value in directives.items())
    lines = [
        "<!DOCTYPE html>",
        '<html lang="en"><head><meta charset="utf-8">',
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">',
        '<meta name="viewport" content="width=device-width, initial-scale=1, viewport-fit=cover">',
        '<link rel="icon" href="data:,">',
        f"<title>{html.escape(' '.join(title.split()))}</title>",
        *([head] if head else []),
        *([f"<style>{style}</style>"] if style else []),
        f"</head><body>{body}",
        *(f"<script>{script}</script>" for script in scripts),
        "</body></html>",
        "",
    ]
    return "\n".join(lines)


def report(title: str, body: str, style: str = "") -> str:
    """A `page` in the style of all reports.

    `body`: markup, in which texts are escaped; `style`: further CSS.
    """
    return page(title, f"<main>{body}</main>", files(__package__).joinpath("report.css").read_text("utf-8") + style)


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode('utf-8')).digest()).decode('ascii')}'"
