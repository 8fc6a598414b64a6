"""Tyre property files: what is read, what is named, what is refused."""

import random
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mbs.tyre_files import TyreFileError, read_tyre
from tests.elements.test_magic_tyre import element_of, kernel, pose

DATA = Path(__file__).parent / "data"
OWN = DATA / "assumed_61.tir"
SEDAN = DATA / "chrono" / "Sedan_Pac02Tire.tir"


def written(folder: Path, text: str | bytes) -> Path:
    file = folder / "tyre.tir"
    file.write_bytes(text.encode() if isinstance(text, str) else text)
    return file


def changed(folder: Path, *changes: tuple[str, str], of: Path = OWN) -> Path:
    text = of.read_text()
    for old, new in changes:
        text, count = re.subn(rf"(?m)^{re.escape(old)}\b.*$", new, text)
        assert count == 1, old
    return written(folder, text)


def test_versions_sides_and_ways_to_combine() -> None:
    results = {}
    for file in sorted(DATA.rglob("*.tir")):
        f = read_tyre(file)
        results[file.stem] = (f.values["version"], f.side, f.values["combination"])
    assert results == {
        "assumed_52": ("MF52", "left", "weighting"),
        "assumed_61": ("MF61", "left", "weighting"),
        "assumed_62": ("MF62", "left", "weighting"),
        "335_65R22_5_G275MSA_60psi": ("PAC2002", "left", "ellipse"),
        "HMMWV_Pac02Tire": ("PAC2002", "left", "weighting"),
        "Sedan_Pac02Tire": ("PAC2002", "left", "ellipse"),
        "mf_185_80R14": ("PAC2002", "left", "weighting"),
    }
    assert read_tyre(OWN).notes == ()


def test_missing_and_unused_entries_of_a_file_are_named() -> None:
    notes = " ".join(read_tyre(SEDAN).notes)
    assert "RBX1, RCX1, RBY1, RCY1 missing or 0: slips are combined by the friction ellipse" in notes
    assert "QSY1" in notes
    notes = " ".join(read_tyre(DATA / "chrono" / "335_65R22_5_G275MSA_60psi.tir").notes)
    assert "[DEFLECTION_LOAD_CURVE] is not used" in notes
    assert "no relaxation" in notes
    assert "KPUMAX 0" in notes
    (fades,) = read_tyre(DATA / "chrono" / "HMMWV_Pac02Tire.tir").notes
    assert "longitudinal slip stiffness fades" in fades


UNITS = (
    ("LENGTH", "LENGTH = 'mm'"),
    ("FORCE", "FORCE = 'pound_force'"),
    ("TIME", "TIME = 'millisecond'"),
    ("UNLOADED_RADIUS", "UNLOADED_RADIUS = 310.75"),
    ("WIDTH", "WIDTH = 185"),
    ("RIM_RADIUS", "RIM_RADIUS = 190.5"),
    ("RIM_WIDTH", "RIM_WIDTH = 139.7"),
    ("LONGVL", "LONGVL = 16.7"),
    ("VXLOW", "VXLOW = 1"),
)
N = 1.0 / 4.4482216152605
PRESSURE = 1e-6 / 4.4482216152605


def test_units_change_the_numbers_and_not_the_tyre(tmp_path: Path) -> None:
    forces = {"FNOMIN": 3000, "FZMIN": 100, "FZMAX": 13000}
    stiffnesses = {"VERTICAL_STIFFNESS": 190e3, "BOTTOM_STIFF": 950e3}
    stiffnesses |= {"LONGITUDINAL_STIFFNESS": 300e3, "LATERAL_STIFFNESS": 120e3}
    more = [(k, f"{k} = {v * N:.15g}") for k, v in forces.items()]
    more += [(k, f"{k} = {v * N / 1000.0:.15g}") for k, v in stiffnesses.items()]
    more += [("VERTICAL_DAMPING", f"VERTICAL_DAMPING = {200 * N:.15g}")]  # 1000 ms, 1000 mm
    more += [("INFLPRES", f"INFLPRES = {230000 * PRESSURE:.15g}"), ("NOMPRES", f"NOMPRES = {220000 * PRESSURE:.15g}")]
    a, b = read_tyre(OWN), read_tyre(changed(tmp_path, *UNITS, *more))
    assert b.pressure == pytest.approx(a.pressure, rel=1e-12)
    for key, value in a.values.items():
        if isinstance(value, (float, dict, tuple)):
            assert b.values[key] == pytest.approx(value, rel=1e-12), key


def test_a_symmetric_tyre_has_no_side(tmp_path: Path) -> None:
    f = read_tyre(changed(tmp_path, ("TYRESIDE", "TYRESIDE = 'SYMMETRIC'")))
    t = f.tyre("right")
    assert t == f.tyre("left")
    # of 6.1 a factor of the camber's magnitude, of 5.2 one of its sign
    assert t.coefficients["QDZ3"] == read_tyre(OWN).values["coefficients"]["QDZ3"] != 0.0
    old = read_tyre(changed(tmp_path, ("TYRESIDE", "TYRESIDE = 'SYMMETRIC'"), ("FITTYP", "FITTYP = 52")))
    assert old.values["coefficients"]["QDZ3"] == 0.0
    element = element_of(t)
    a, b = (kernel(element, *pose(t, 3000.0, 0.03, s * 0.05, s * 0.1, 20.0))[0] for s in (1.0, -1.0))
    assert (b.Fx, -b.Fy, -b.Mx, b.My, -b.Mz) == pytest.approx((a.Fx, a.Fy, a.Mx, a.My, a.Mz), rel=1e-12)


def test_pressure_changes_the_forces_as_far_as_the_file_knows_it() -> None:
    f = read_tyre(OWN)
    soft, hard = (f.tyre(pressure=p) for p in (180e3, 260e3))
    assert soft.pressure == pytest.approx(180.0 / 220.0 - 1.0)
    a, b = (kernel(element_of(t), *pose(t, 3000.0, 0.0, 0.01, 0.0, 20.0))[0].Fy for t in (soft, hard))
    assert abs(a - b) > 20.0
    with pytest.raises(TyreFileError, match=r"at 10000 Pa PFZ1 leaves -0\.\d+ of the vertical stiffness"):
        replace(f, values=f.values | {"coefficients": f.values["coefficients"] | {"PFZ1": 1.5}}).tyre(pressure=1e4)
    with pytest.raises(TyreFileError, match="no NOMPRES"):
        read_tyre(SEDAN).tyre(pressure=2e5)


def test_the_vertical_stiffness_of_a_file_is_that_at_the_nominal_load(tmp_path: Path) -> None:
    """Fz = F0 (Q_FZ1 d/R + Q_FZ2 (d/R)^2), Pacejka 2012, eq. 4.E68: its slope at F0 is VERTICAL_STIFFNESS."""
    f = read_tyre(OWN)
    tyre = f.tyre(pressure=f.nominal_pressure)
    radius, load, stiffness, second = tyre.radius, tyre.nominal_load, 190000.0, 14.5
    first = ((stiffness * radius / load) ** 2 - 4.0 * second) ** 0.5

    def force(d: float) -> float:
        u, ud = np.zeros(7), np.zeros(7)
        u[2], u[4] = radius * tyre.coefficients["Q_RE0"] - d, 1.0
        return kernel(element_of(tyre), u, ud)[1]

    for d in (0.005, 0.015, 0.04):
        assert force(d) == pytest.approx(load * (first * d / radius + second * (d / radius) ** 2), rel=1e-9)
    nominal = radius * ((first**2 + 4.0 * second) ** 0.5 - first) / (2.0 * second)
    assert force(nominal) == pytest.approx(load, rel=1e-9)
    assert (force(nominal + 1e-5) - force(nominal - 1e-5)) / 2e-5 == pytest.approx(stiffness, rel=1e-6)
    both = read_tyre(changed(tmp_path, ("Q_FZ2", f"Q_FZ2 = {second}\nQ_FZ1 = 15.0")))
    (note,) = (n for n in both.notes if "VERTICAL_STIFFNESS" in n)
    assert note.startswith("VERTICAL_STIFFNESS is 1.9e+05 N/m and Q_FZ1 and Q_FZ2 give 1.624e+05 N/m at FNOMIN")


def test_signs_that_do_not_fit_are_refused(tmp_path: Path) -> None:
    with pytest.raises(TyreFileError, match=r"PKY1 is -17\.5; with the signs 'adapted_sae' it must be positive"):
        read_tyre(OWN).tyre(signs="adapted_sae")
    turned = read_tyre(changed(tmp_path, ("PKY1", "PKY1 = 17.5")))
    for signs in ("iso", "sae"):
        with pytest.raises(TyreFileError, match="must be negative"):
            turned.tyre(signs=signs)
    assert turned.tyre(signs="adapted_sae").signs == "adapted_sae"
    with pytest.raises(TyreFileError, match="side of the tyre"):
        turned.tyre("middle")


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (("PROPERTY_FILE_FORMAT", "PROPERTY_FILE_FORMAT = 'FTIRE'"), "PROPERTY_FILE_FORMAT in [MODEL] is 'FTIRE'"),
        (("FITTYP", "FITTYP = 60"), "FITTYP is 60"),
        (("LENGTH", "LENGTH = 'yard'"), "LENGTH in [UNITS] is 'yard'"),
        (("TIME", ""), "TIME in [UNITS] is missing"),
        (("PDX1", "PDX1 = 0"), "PDX1 is missing or 0"),
        (
            ("PDX1", "PDX1 = '1.2'"),
            "PDX1 in [LONGITUDINAL_COEFFICIENTS] is the text '1.2'; it must be a number, without",
        ),
        (("Q_FZ2", "Q_FZ2 = 100"), "Q_FZ2 must be below 96.83, or Q_FZ1 be given"),
        (("PCX1", "PCX1 = 1.2.3"), "PCX1 is 1.2.3, without quotation marks; it must be a number"),
        (("PCX1", "PCX1 = 1e999"), "it must be finite"),
        (("PCX1", "PCX1 = "), "PCX1 is empty"),
        (("PCX1", "PCX1 = 1.5\nPCX1 = 1.6"), "PCX1 stands twice"),
        (("PCX1", "what is this"), "neither a section, a key with its value nor a comment"),
        (("TYRESIDE", "TYRESIDE = 'LEFT"), "quotation mark is not closed"),
        (("[UNITS]", "no section"), "no section"),
        (("[LATERAL_COEFFICIENTS]", "[MODEL]"), "[MODEL] stands twice"),
        (("KPUMIN", "KPUMIN = 0.5"), "0 must lie between them"),
        (("LKY", "LKY = -1"), "LKY is -1; it must be positive"),
        (("VERTICAL_DAMPING", "VERTICAL_DAMPING = -1"), "VERTICAL_DAMPING is -1 N s/m; it must lie between 0 and"),
        (("LFZO", "LFZO = 1e308"), "LFZO is 1e+308; it must lie between -10000 and 10000"),
        (("PKY1", "PKY1 = -17,5"), "PKY1 is '-17,5'; its decimal mark must be a point, as in -17.5"),
        (("Q_FZ2", "Q_FZ2 = -200"), "becomes soft before the rim bears"),
        (("PKX1", "PKX1 = -20"), "PKX1 is -20; it must be positive"),
        (("RIM_RADIUS", "RIM_RADIUS = 0.4"), "must be below UNLOADED_RADIUS"),
        (("PDY2", "PDY2 = 1.05"), "the lateral friction is"),
        (("FITTYP", "FITTYP = 61\nPCX1 = 3"), "in one section and"),
        (("FZMIN", "FZMIN = 20000"), "FZMIN is 20000 N and FZMAX 13000 N; the first must be the smaller"),
        (("FREFF", "FREFF = 50"), "DREFF atan(BREFF) + FREFF is 50.4; under FNOMIN"),
    ],
)
def test_impossible_values_are_refused_in_one_sentence(tmp_path: Path, change: tuple[str, str], sentence: str) -> None:
    text = OWN.read_text()
    old, new = change
    assert re.search(rf"(?m)^{re.escape(old)}( .*)?$", text), old
    file = written(tmp_path, re.sub(rf"(?m)^{re.escape(old)}( .*)?$", lambda _: new, text, count=1))
    with pytest.raises(TyreFileError, match=re.escape(sentence)) as error:
        read_tyre(file)
    assert str(file) in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"", "is empty"),
        (b"\xff\xfe[\0U\0", "not text of single bytes"),
        (b"a" * 1_000_001, "it must have at most 1000000"),
        (b"[UNITS]\n" + b"x" * 1001, "it must have at most 1000"),
        (b"PK\x03\x04 zip", "is before any section"),
    ],
)
def test_what_is_no_text_of_such_a_file_is_refused(tmp_path: Path, content: bytes, sentence: str) -> None:
    with pytest.raises(TyreFileError, match=re.escape(sentence)):
        read_tyre(written(tmp_path, content))
    with pytest.raises(TyreFileError, match="folder"):
        read_tyre(tmp_path)


def test_comments_and_texts_in_latin_1_are_read(tmp_path: Path) -> None:
    text = (
        OWN.read_text()
        .replace("$ Assumed", "$ für jeden Größenfall", 1)
        .replace("PCX1 = 1.58", "pcx1=+1.58D0 $ shape !")
    )
    assert read_tyre(written(tmp_path, text.encode("latin-1"))).values == read_tyre(OWN).values


def test_a_cut_or_altered_file_is_a_tyre_or_a_sentence(tmp_path: Path) -> None:
    """No other error, and what is read can be evaluated."""
    rng, data, read = random.Random(5), SEDAN.read_bytes(), 0
    names_file: set[bool] = set()
    for k in range(400):
        if k % 2:
            content = data[: rng.randrange(len(data))]
        else:
            content = bytearray(data)
            for _ in range(rng.randint(1, 5)):
                content[rng.randrange(len(content))] = rng.randrange(256)
        try:
            tyre = read_tyre(written(tmp_path, bytes(content))).tyre()
        except TyreFileError as error:
            names_file.add("tyre.tir" in str(error))
            continue
        read += 1
        assert element_of(tyre).check() is None
    assert names_file == {True}
    assert 20 < read < 380


def test_a_side_that_is_not_known_is_reported(tmp_path: Path) -> None:
    f = read_tyre(changed(tmp_path, ("TYRESIDE", "TYRESIDE = 'UNKNOWN'")))
    assert f.notes == ("TYRESIDE is 'unknown': coefficients of a left tyre are assumed, and a right one is mirrored.",)
    assert f.side == "left"


def test_a_negative_use_mode_mirrors(tmp_path: Path) -> None:
    """A wheel of the left side then has the mirror image of what the coefficients of a left tyre say."""
    plain = read_tyre(OWN)
    f = read_tyre(changed(tmp_path, ("USE_MODE", "USE_MODE = -14")))
    assert f.notes == ("USE_MODE is -14, which mirrors: the coefficients count as a right tyre's.",)
    assert (plain.side, f.side) == ("left", "right")
    assert f.tyre("left") == plain.tyre("right")
    assert f.tyre("right") == plain.tyre("left")
    assert f.tyre("left") != plain.tyre("left")


def test_ranges_that_the_tyre_leaves_are_reported(tmp_path: Path) -> None:
    (note,) = read_tyre(changed(tmp_path, ("FZMAX", "FZMAX = 2000"))).notes
    assert note == "FZMAX is 2000 N, below FNOMIN, 3000 N; above FZMAX the forces stay."
    f = read_tyre(changed(tmp_path, ("NOMPRES", "NOMPRES = 220000\nPRESMIN = 1.9e5\nPRESMAX = 2.2e5")))
    hold = "the coefficients hold from PRESMIN, 190000 Pa, to PRESMAX, 220000 Pa."
    assert f.notes == (f"INFLPRES is 230000 Pa; {hold}",)
    with pytest.raises(TyreFileError, match=re.escape(f"the pressure is 240000 Pa; {hold}")):
        f.tyre(pressure=2.4e5)
    assert f.tyre(pressure=2.1e5).pressure == pytest.approx(21.0 / 22.0 - 1.0)
