"""Which share of a study's runs keeps its limits: printed and written."""

from __future__ import annotations

from pathlib import Path

from hosts.study.limits import share_notes, share_rows, shares, write_shares
from hosts.study.store import read_study


def tell_limits(folder: Path) -> bool:
    """Print and write the shares of a study that has limits; whether all runs keep them."""
    frame = read_study(folder)
    found = shares(frame)
    rows = [("limits", "", "within", "share", "95 %"), *share_rows(found, frame.attrs)]
    widths = [max(len(row[k]) for row in rows) for k in range(5)]
    for row in rows:
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip())
    for note in share_notes(found, frame.attrs):
        print(note)
    print(f"written: {' and '.join(map(str, write_shares(found, folder)))}")
    return all(share.outside == 0 for share in found)
