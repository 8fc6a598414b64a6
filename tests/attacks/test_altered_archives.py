"""Randomly altered archives: nothing is written outside the folder; a refusal is one sentence with the file."""

import random
import shutil
import stat
import warnings
import zipfile
from pathlib import Path

import pytest

from ali3.archives import Archive, faults_of
from hosts.check.documents import check_archive
from tests.altered_files import altered
from tests.attacks.bounds import seeds
from tests.commands.test_archives import DESCRIPTION
from tests.commands.test_untrusted_files import fault_of

_PARTS = ("a", "A", "..", ".", "", "sources", "CON", "x" * 300, "\x00", "é", "C:", "a\nb", "resources", "a.c", "\\")
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA)
_MODES = (0, stat.S_IFREG, stat.S_IFLNK, stat.S_IFIFO, stat.S_IFDIR, stat.S_IFCHR)


def archive(file: Path, seed: int) -> None:
    """An FMU with entries of any name, kind and method; of half of them bytes are altered."""
    chance = random.Random(seed)
    with warnings.catch_warnings(), zipfile.ZipFile(file, "w") as target:
        warnings.simplefilter("ignore")  # of doubled names
        target.writestr("modelDescription.xml", DESCRIPTION.format(""))
        for _ in range(chance.randrange(6)):
            name = "/".join(chance.choice(_PARTS) for _ in range(chance.randrange(1, 4)))
            info = zipfile.ZipInfo("a")
            info.filename = name
            info.external_attr = (chance.choice(_MODES) | 0o777) << 16
            info.compress_type = chance.choice(_METHODS)
            target.writestr(info, b"/etc/passwd" * chance.choice((1, 1, 10_000)))
    if chance.random() < 0.5:
        file.write_bytes(altered(file.read_bytes(), seed))


def check(seed: int, folder: Path) -> bool:
    """Whether the archive of a seed is unpacked."""
    inside = folder / "inside"
    inside.mkdir()
    file = folder / "by_chance.fmu"
    archive(file, seed)
    before = sorted(folder.iterdir())

    def unpack(path: Path) -> None:
        with Archive(path) as opened:
            opened.unpack(inside)

    fault = fault_of(unpack, file, may_be_read=False)
    assert fault in ("", "it is read"), f"seed {seed}: {fault}"
    assert sorted(folder.iterdir()) == before, f"seed {seed}"
    for unpacked in inside.rglob("*"):
        assert unpacked.is_dir() or (unpacked.is_file() and not unpacked.is_symlink()), f"seed {seed}: {unpacked}"
    if fault == "it is read":
        assert faults_of(file) == [], f"seed {seed}"
        assert not [finding for finding in check_archive(file) if finding.verdict == "bad"], f"seed {seed}"
    shutil.rmtree(inside)
    return fault == "it is read"


@pytest.mark.slow
def test_archives_are_unpacked_in_their_folder_or_refused(tmp_path: Path) -> None:
    unpacked = sum(check(seed, tmp_path) for seed in range(200))
    assert 20 < unpacked < 180


@pytest.mark.proof
@pytest.mark.attack
def test_archives_by_chance_are_unpacked_in_their_folder_or_refused(tmp_path: Path) -> None:
    for seed in seeds("archives"):
        check(seed, tmp_path)
