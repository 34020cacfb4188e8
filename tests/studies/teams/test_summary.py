"""What each further robot saves, in sentences and as a table."""

from dataclasses import replace

import pytest

from fieldmon.studies.teams.seasons import TeamOutcome
from fieldmon.studies.teams.summary import HEADS, cells, rows, sentences, table

TOGETHER, APART = "adaptive, together, at once", "adaptive, sections"


def outcomes(seeds=(1, 2, 3), name="1 ha spread 10% to one abcd"):
    made = []
    for seed in seeds:
        loss = 100.0 + 10 * seed
        for robots, who, share in (
            (1, "adaptive", 1.0), (2, TOGETHER, 0.5), (3, TOGETHER, 0.4), (2, APART, 0.6),
        ):  # fmt: skip
            row = (1.0, 0.1, share * loss, 6.0 - robots, 12.0 * robots, 9.0)
            made.append(TeamOutcome(name, who, robots, seed, *row))
    return made


def test_one_alone_is_the_first_of_every_way_to_work():
    made = rows(outcomes(), 25)
    assert [(row.who, row.robots) for row in made] == [
        (TOGETHER, 1), (TOGETHER, 2), (TOGETHER, 3), (APART, 1), (APART, 2),
    ]  # fmt: skip
    assert made[0].gain is None
    assert made[1].gain.saved.mean == pytest.approx(60.0)
    assert made[2].gain.saved.mean == pytest.approx(12.0)
    assert made[4].gain.saved.mean == pytest.approx(48.0)
    assert made[2].worked_h.mean == 36.0


def test_a_seed_that_some_team_has_not_met_yet_does_not_count():
    half = [one for one in outcomes((1, 2, 3)) if one.seed < 3 or one.robots < 3]
    together = [row for row in rows(half, 25) if row.who == TOGETHER]
    assert {row.loss.replicates for row in together} == {2}


def test_seasons_that_never_reach_80_percent_are_no_days():
    some = [replace(one, d80=26.0) if one.seed == 3 else one for one in outcomes()]
    assert {cells(row)[-2] for row in rows(some, 25)} == {
        f"{d}.0 in 2 of 3 seasons" for d in (5, 4, 3)
    }
    never = [replace(one, d80=26.0) for one in outcomes()]
    assert {cells(row)[-2] for row in rows(never, 25)} == {"not in 25"}
    assert {cells(row)[-2] for row in rows(outcomes(), 25)} == {"5.0", "4.0", "3.0"}


def test_alone_there_is_nothing_to_say_but_the_loss():
    made = rows([one for one in outcomes() if one.robots == 1], 25)
    assert [(row.who, row.robots) for row in made] == [("adaptive", 1)]
    assert sentences(made) == []


def test_sentences_and_table_name_the_scenario_and_the_way_to_work():
    made = rows(outcomes(), 25)
    said = sentences(made)
    assert len(said) == 2
    assert said[0].startswith(f"1 ha spread 10% to one ({TOGETHER}): A second robot would save 60 ")
    lines = table(made).splitlines()
    assert lines[0] == f"| {' | '.join(HEADS)} |"
    assert len(lines) == 2 + len(made)
    assert all(line.count("|") == len(HEADS) + 1 for line in lines)
