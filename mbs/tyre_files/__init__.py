"""Tyre property files (.tir) of the Magic Formula."""

from mbs.tyre_files.magic_file import TyreFile, read_tyre
from mbs.tyre_files.property_text import TyreFileError
from mbs.tyre_files.tyre_plausibility import magic_plausibility

__all__ = ["TyreFile", "TyreFileError", "magic_plausibility", "read_tyre"]
