"""Results by name: mapping, CSV round trip, plot."""

import numpy as np
import pytest

from mbs.results.trajectory import Trajectory

SEED = 20240311


@pytest.fixture
def trajectory():
    rng = np.random.default_rng(SEED)
    names = ["bob.x", "wheel[1], load", "energy"]
    return Trajectory(0.1 * np.arange(5), rng.normal(size=(5, 3)), names, ["m", "N", "J"], wall_s=0.2)


def test_it_maps_names_to_arrays_with_units(trajectory):
    assert list(trajectory) == ["bob.x", "wheel[1], load", "energy"]
    assert trajectory["energy"].shape == (5,)
    assert trajectory.units["wheel[1], load"] == "N"
    assert len(trajectory) == 3


def test_an_unknown_name_is_reported_with_the_known_ones(trajectory):
    with pytest.raises(KeyError, match=r"no sensor 'bob.y'; did you mean 'bob.x'\?"):
        trajectory["bob.y"]
    with pytest.raises(KeyError, match=r"no sensor 'speed'; the trajectory has: bob.x, wheel\[1\], load, energy\."):
        trajectory["speed"]
    many = Trajectory(np.arange(2.0), np.zeros((2, 30)), [f"row{k}" for k in range(30)], ["m"] * 30, wall_s=0.2)
    with pytest.raises(KeyError, match=r"row11 and 18 more\."):
        many["speed"]


def test_csv_keeps_every_bit_name_and_unit(trajectory, tmp_path):
    path = tmp_path / "run.csv"
    trajectory.to_csv(path)
    assert path.read_text(encoding="utf-8").splitlines()[0] == 'time [s],bob.x [m],"wheel[1], load [N]",energy [J]'
    again = Trajectory.from_csv(path)
    assert again.units == trajectory.units
    assert again.t.tobytes() == trajectory.t.tobytes()
    for name in trajectory:
        assert again[name].tobytes() == trajectory[name].tobytes()


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("time [ms],b [m]\n", r"the first line must be 'time \[s\]'"),
        ("a [m],b [m]\n", r"the first line must be 'time \[s\]'"),
        ("time [s],b\n", r"the heading 'b' must read 'name \[unit\]'"),
    ],
)
def test_a_csv_of_another_kind_is_refused(text, sentence, tmp_path):
    path = tmp_path / "other.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=sentence):
        Trajectory.from_csv(path)


def test_plot_draws_one_axes_per_unit(trajectory):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    figure = trajectory.plot()
    assert [ax.get_ylabel() for ax in figure.axes] == ["m", "N", "J"]
    only = trajectory.plot("energy")
    np.testing.assert_array_equal(only.axes[0].lines[0].get_ydata(), trajectory["energy"])
    matplotlib.pyplot.close("all")
