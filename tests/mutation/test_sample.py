"""Every stored outcome of a mutant drawn by chance is still in the code."""

import pytest

from tests.mutation.command import STORED, read


@pytest.mark.slow
def test_every_stored_mutant_is_in_the_code() -> None:
    gone = []
    for mutant in read(STORED):
        try:
            mutant.apply()
        except ValueError as error:
            gone.append(str(error))
    assert not gone, "\n".join([*gone, f"write the same error into the new text in {STORED.name}, or remove its entry"])
