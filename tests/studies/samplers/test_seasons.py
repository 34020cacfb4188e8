"""Samplers side by side: paired, resumable, and summed up as they are."""

import numpy as np
import pytest
from typer.testing import CliRunner

from fieldmon.cli import main
from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import FileProblem, SettingError
from fieldmon.infestation.spread import Spread
from fieldmon.studies.samplers.report import report_html
from fieldmon.studies.samplers.scenarios import PRIORS, STARTS, Cell, all_cells, usual_cells
from fieldmon.studies.samplers.seasons import (
    ADAPTIVE,
    CLAIRVOYANT,
    NAMES,
    RIVALS,
    SOME,
    WORDED,
    Outcome,
    outcomes,
    run,
)
from fieldmon.studies.samplers.summary import by_cell, csv_text, outcomes_from, ratio, sentences
from fieldmon.studies.samplers.tuning import CHOICES, losses

SMALL = Cell("A", Spread(0.5, "one"))
ALWAYS = [rival.name for rival in RIVALS if rival.every == 1]


@pytest.fixture(scope="module")
def made():
    return [outcome for seed in (0, SOME, 1) for outcome in outcomes(SMALL, seed)]


def test_every_rival_gets_one_outcome_a_seed_and_bounds_are_in_every_tenth(made):
    for seed, who in ((0, NAMES), (SOME, NAMES), (1, ALWAYS)):
        assert [o.who for o in made if o.seed == seed] == list(who)


def test_who_knows_the_truth_loses_least(made):
    for seed in (0, SOME):
        loss = {o.who: o.infested_plant_days for o in made if o.seed == seed}
        assert loss[CLAIRVOYANT] == min(loss.values())


def test_the_same_cell_and_seed_give_the_same_outcomes(made):
    assert outcomes(SMALL, 1) == made[-len(ALWAYS) :]


def test_what_is_done_is_not_run_again(made):
    done = frozenset({(SMALL.name, 0)})
    rows = list(run([SMALL], [0, 1], done))
    assert rows == [made[-len(ALWAYS) :]]


def test_every_one_of_dynamics_choices_is_tried():
    tried = dict(losses([Cell("B", start="scattered")], [0]))
    assert list(tried) == list(CHOICES)
    assert min(tried.values()) > 0
    assert len(set(tried.values())) > len(CHOICES) / 4


def test_a_table_is_read_back_as_it_was_written(made):
    assert outcomes_from(csv_text(made), "samplers.csv") == made
    with pytest.raises(FileProblem, match="must be a table of this study"):
        outcomes_from("a,b\n1,2\n", "samplers.csv")


def test_a_ratio_of_twice_as_much_is_two_and_its_interval_holds_it():
    values = np.random.default_rng(1).gamma(2.0, size=40)
    twice = ratio(2 * values, values)
    assert (twice.value, twice.low, twice.high) == pytest.approx((2.0, 2.0, 2.0))
    noisy = ratio(2 * np.random.default_rng(2).gamma(2.0, size=40), values)
    assert noisy.low < 2.0 < noisy.high


def test_a_sampler_that_is_worse_is_called_worse(made):
    worse = [
        Outcome(o.cell, o.seed, o.who, 99.0 if o.who == ADAPTIVE else 10.0, *[1.0] * 5)
        for o in made
    ]
    said = " ".join(sentences(worse))
    assert "fewer in 0; geometric mean 9.90 x" in said
    assert f"More than 5 % worse than {WORDED} in: {SMALL.name}." in said


def test_the_report_names_every_rival(made):
    page = report_html(made)
    assert all(name in page for name in NAMES)
    assert SMALL.name in page


@pytest.mark.parametrize("start", STARTS)
def test_a_season_starts_with_the_share_of_infested_plants_that_it_says(start):
    shares = [Cell("B", start=start).begin(RandomStreams(s)).infested.mean() for s in range(20)]
    assert np.mean(shares) == pytest.approx(0.015, rel=0.15)


@pytest.mark.parametrize("prior", PRIORS)
def test_a_prior_expects_about_as_many_as_there_are(prior):
    start = Cell("B", prior=prior).begin(RandomStreams(3))
    assert start.chance.mean() == pytest.approx(0.015, rel=0.5)
    assert ((start.chance > 0) & (start.chance < 1)).all()


def test_cells_have_names_of_their_own_and_cover_every_level():
    assert len({cell.name for cell in all_cells()}) == len(all_cells()) > len(usual_cells())
    usual = usual_cells()
    assert {cell.prior for cell in usual} == set(PRIORS)
    assert {cell.start for cell in usual} == set(STARTS)


def test_an_unknown_level_is_refused():
    with pytest.raises(SettingError, match="scenario must be one of 'A', 'B', 'C'"):
        Cell("D")


def test_by_cell_pairs_seeds(made):
    table = by_cell(made[::-1], "found")
    assert table[SMALL.name][ADAPTIVE].tolist() == [o.found for o in made if o.who == ADAPTIVE]


def test_the_command_writes_table_and_report_and_goes_on_where_it_stopped(tmp_path):
    args = ["study", "samplers", "--cell", "A,", "-o", str(tmp_path), "--seeds"]
    for seeds in ("2", "3"):
        result = CliRunner().invoke(main.app, [*args, seeds])
        assert result.exit_code == 0, result.output
        table = outcomes_from((tmp_path / "samplers.csv").read_text(), "samplers.csv")
        assert len(table) == len(NAMES) + (int(seeds) - 1) * len(ALWAYS)
    assert "Infested plant-days against dynamic, tuned" in result.output
    assert (tmp_path / "samplers.html").stat().st_size > 2000
