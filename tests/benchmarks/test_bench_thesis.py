"""The thesis's simulator: one run, and all rows of its tables."""

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.studies.thesis.chapter4 import draws, listings
from fieldmon.studies.thesis.chapter4.listing_errors import AS_PUBLISHED
from fieldmon.studies.thesis.chapter4.study import run_no_prior
from fieldmon.studies.thesis.chapter4.trial import NoPriorTrial, ThesisStrategy, night_of, walk_of
from fieldmon.studies.thesis.chapter4.vineyard import SCENARIOS


def test_one_published_replicate_of_three_days_in_scenario_c(benchmark):
    """Under 1 ms once compiled, random numbers included."""
    trial = NoPriorTrial(SCENARIOS["C"], ThesisStrategy(6), 1)
    walk, night = walk_of(trial, AS_PUBLISHED), night_of(trial, AS_PUBLISHED)
    keys = draws.keys(RandomStreams(1), 1, 3)
    days, _ = benchmark(listings.repeat, walk, night, trial.START, 0, keys)
    assert days.shape == (1, 3, 8)


def test_400_replicates_of_all_rows_of_tables_2_to_4(benchmark):
    """Under 20 s on two cores, with progress and table 5 from the same runs."""
    told = []

    def make():
        return run_no_prior("2-5", 400, 1, lambda done, total: told.append((done, total)))

    study = benchmark.pedantic(make, rounds=3, warmup_rounds=1)
    assert told[-1] == (30, 30)
    assert len(study.cells) == 3 * 140 + 120
