"""Every stored outcome of a mutant drawn by chance is still in the code."""

import json

import pytest

from tests.mutation.command import STORED, stored
from tests.mutation.table import ROOT


@pytest.mark.slow
def test_every_stored_mutant_is_in_the_code() -> None:
    gone = []
    for mutant in map(stored, json.loads(STORED.read_text(encoding="utf-8"))["mutants"]):
        try:
            mutant.apply()
        except ValueError as error:
            gone.append(str(error))
        file, _, test = mutant.killed_by.partition("::")
        if file and test.partition("[")[0].split("::")[-1] not in (ROOT / file).read_text(encoding="utf-8"):
            gone.append(f"gone, look at it by hand: the test {mutant.killed_by}")
    assert not gone, "\n".join([*gone, f"write the same error into the new text in {STORED.name}, or remove its entry"])
