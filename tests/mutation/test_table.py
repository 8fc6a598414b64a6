"""Every row of the tables of mutants still applies, and names tests that are there."""

from tests.mutation.table import ROOT, all_mutants

LEAST = 200


def test_every_row_applies_exactly_once() -> None:
    mutants = all_mutants()
    assert len(mutants) > LEAST
    wrong = []
    for mutant in mutants:
        wrong += [f"{mutant}: there is no {test}" for test in mutant.tests if not (ROOT / test).is_file()]
        try:
            mutant.apply()
        except ValueError as error:
            wrong.append(str(error))
    assert not wrong, "\n".join(wrong)
