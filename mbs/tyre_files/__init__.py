"""Tyre property files (.tir) of the Magic Formula."""

from mbs.tyre_files.magic_file import TyreFile, read_tyre
from mbs.tyre_files.property_text import TyreFileError

__all__ = ["TyreFile", "TyreFileError", "read_tyre"]
