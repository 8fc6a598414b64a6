"""Which share of a study's runs keeps its limits: printed and written."""

from __future__ import annotations

from pathlib import Path

from ali3.columns import in_columns
from hosts.study.limits import share_notes, share_rows, shares, write_shares
from hosts.study.store import read_study


def tell_limits(folder: Path) -> bool:
    """Print and write the shares of a study that has limits; whether all runs keep them."""
    frame = read_study(folder)
    found = shares(frame)
    lines = in_columns([("limits", "", "within", "share", "95 %"), *share_rows(found, frame.attrs)])
    print("\n".join([*lines, *share_notes(found, frame.attrs)]))
    print(f"written: {' and '.join(map(str, write_shares(found, folder)))}")
    return all(share.outside == 0 for share in found)
