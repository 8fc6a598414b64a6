"""The classes of ISO 8608: spectra measured back from the heights, coherence of two tracks, seeds."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.special import k1

from mbs.roads import RoadFileError, read_road
from mbs.roads.rough_road import ISO_8608, MAX_FREQUENCY, rough_heights

Array = NDArray[np.float64]
BOUNDS = {
    "A": (0.0, 32e-6),
    "B": (32e-6, 128e-6),
    "C": (128e-6, 512e-6),
    "D": (512e-6, 2048e-6),
    "E": (2048e-6, 8192e-6),
}
BOUNDS["F"] = (8192e-6, 32768e-6)
"""m3: lower and upper limit of Gd(0.1 1/m), ISO 8608:2016, table C.2, written down from there."""
CENTRES = 2.0 ** np.arange(-4, 2)
"""1/m: octave bands, ISO 8608:2016, 5.1.2, of which the road holds enough waves."""
SPACING = 0.125  # m
LENGTH = 250.0  # m


def density(tracks: Array) -> tuple[Array, Array, Array]:
    """Spatial frequencies, densities and spectra of tracks (n, m) over the first axis, with a Hann window."""
    window = np.hanning(len(tracks))[:, None]
    spectra = np.fft.rfft((tracks - tracks.mean(axis=0)) * window, axis=0)
    return np.fft.rfftfreq(len(tracks), SPACING), 2.0 * SPACING / np.sum(window**2) * np.abs(spectra) ** 2, spectra


def described(folder, roughness: str, seed: int = 3):
    (folder / "a.toml").write_text(
        f'kind = "rough"\nstart = 0.0\nlength = {LENGTH}\nwidth = 20.0\nspacing = {SPACING}\n'
        f'roughness = "{roughness}"\nseed = {seed}\n'
    )
    return read_road(folder / "a.toml")


@pytest.mark.parametrize("roughness", list(ISO_8608))
def test_the_density_lies_within_the_bounds_of_the_class(tmp_path, roughness: str) -> None:
    """In every octave; of one profile, as a measuring car sees it, the straight line through the octaves."""
    heights = np.asarray(described(tmp_path, roughness).heights)[80:-80]
    n, result, _ = density(heights)
    low, high = BOUNDS[roughness]
    reduced = result * (np.maximum(n, 1e-9) / 0.1)[:, None] ** 2  # Gd(n0), if it falls with the square
    bands = [(n >= c / np.sqrt(2.0)) & (n < c * np.sqrt(2.0)) for c in CENTRES]
    in_bands = np.array([reduced[band].mean(axis=0) for band in bands])
    assert np.all((low < in_bands.mean(axis=1)) & (in_bands.mean(axis=1) < high))
    one = np.exp(np.log(in_bands[:, 0]).mean())
    assert low < one < high
    slope = np.polyfit(np.log(CENTRES), np.log(in_bands.mean(axis=1) * (0.1 / CENTRES) ** 2), 1)[0]
    assert slope == pytest.approx(-2.0, abs=0.15)


def test_near_its_end_the_density_is_that_of_waves_in_all_directions() -> None:
    """The integral of A (n^2 + m^2)^-1.5 over |m| < sqrt(N^2 - n^2) is the whole one times sqrt(1 - (n/N)^2)."""
    n, actual, _ = density(rough_heights(2000, 2000, SPACING, ISO_8608["B"], 7))
    for low, high in ((0.05, 0.2), (0.2, 0.8), (0.9, 1.1), (1.9, 2.1), (2.4, 2.6)):
        band = (n > low) & (n < high)
        line = ISO_8608["B"] * (0.1 / n[band]) ** 2
        share = np.sqrt(1.0 - (n[band] / MAX_FREQUENCY) ** 2).mean()
        assert (actual[band].mean(axis=1) / line).mean() == pytest.approx(share, rel=0.04), (low, high)


def test_the_coherence_of_two_tracks_is_that_of_an_isotropic_surface() -> None:
    """(x K1(x))^2 with x = 2 pi n b: two tracks of a car go alike over long waves and apart over short ones."""
    heights = rough_heights(2000, 2000, SPACING, ISO_8608["C"], 5)
    for apart in (4, 12):  # 0.5 and 1.5 m
        n, _, spectra = density(heights)
        left, right = spectra[:, :-apart], spectra[:, apart:]
        squared = np.abs((left * right.conj()).mean(axis=1)) ** 2
        squared /= (np.abs(left) ** 2).mean(axis=1) * (np.abs(right) ** 2).mean(axis=1)
        for centre in (0.05, 0.1, 0.2, 0.5):
            band = (n > 0.8 * centre) & (n < 1.25 * centre)
            x = 2.0 * np.pi * n[band] * apart * SPACING
            assert squared[band].mean() == pytest.approx(np.mean((x * k1(x)) ** 2), abs=0.08), (apart, centre)


def test_a_long_road_is_computed_on_a_strip() -> None:
    """2 km: the other side holds the longest wave; the density is that of a square."""
    heights = rough_heights(8000, 8, 0.25, ISO_8608["D"], 1)
    n, result, _ = density(heights)
    n = n * SPACING / 0.25
    band = (n > 0.05) & (n < 0.5)
    reduced = (result * 0.25 / SPACING)[band] * (n[band, None] / 0.1) ** 2
    assert reduced.mean() == pytest.approx(ISO_8608["D"], rel=0.1)


def test_too_many_points_are_refused() -> None:
    with pytest.raises(RoadFileError, match=r"1000001 x 61 points is computed on 1000001 x 909 points"):
        rough_heights(1000001, 61, 0.1, 1e-6, 1)
