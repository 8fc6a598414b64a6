"""Names after ``--fit`` and ``--signals``."""

from hosts.compare.command import _names


def test_commas_part_names_but_not_the_places_of_an_array() -> None:
    assert _names("a.b=1:2,c[1,2]=0.5:3,d") == ["a.b=1:2", "c[1,2]=0.5:3", "d"]
