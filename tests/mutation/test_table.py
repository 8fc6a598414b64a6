"""Every row of the tables of mutants still applies, and names tests that are there."""

from __future__ import annotations

import pytest

from tests.mutation.table import ROOT, Mutant, all_mutants

LEAST = 200


@pytest.mark.parametrize("mutant", all_mutants(), ids=str)
def test_a_row_applies_exactly_once(mutant: Mutant) -> None:
    mutant.apply()
    assert [test for test in mutant.tests if not (ROOT / test).is_file()] == []
