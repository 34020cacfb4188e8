"""What a study compares, and its chunks: by name those of every version before."""

from itertools import product

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon

from fieldmon.errors import SettingError
from fieldmon.infestation.records import PRESENT, Records
from fieldmon.plot.field import Field
from fieldmon.plot.planting import Planting
from fieldmon.simulation.design import Design, study_of
from fieldmon.simulation.study_plot import Combination, StudyPlot
from tests.simulation.study_plots import DAY, SMALL, plot

SQUARE = StudyPlot(
    Field("square", MultiPolygon([shapely.box(35.15, 30.36, 35.1506, 30.3606)])),
    Planting(),
    Records.none(),
    DAY,
)


def test_every_level_meets_every_other():
    asked = Design(("naive", "dynamic"), (1.0, 2.0), (20.0, 40.0), (0.1,), (0.2, 0.3))
    levels = product(("naive", "dynamic"), (1.0, 2.0), (20.0, 40.0), (0.1,), (0.2, 0.3))
    assert asked.combinations == tuple(Combination(*each) for each in levels)


def test_chunks_hold_every_season_once_whatever_the_size_of_the_plot():
    for size_m in (10.0, 400.0):
        study = study_of([plot(size_m)], SMALL)
        seasons = [(chunk.setting[1], seed) for chunk in study.chunks() for seed in chunk.seeds]
        assert len(seasons) == len(set(seasons)) == len(SMALL.combinations) * SMALL.n_seeds


def test_a_bigger_plot_and_a_dearer_sampler_have_fewer_seasons_a_chunk():
    def size(plot, sampler):
        asked = Design((sampler,), n_seeds=10**6)
        return len(next(iter(study_of([plot], asked).chunks())))

    assert size(plot(10.0), "naive") > size(plot(400.0), "naive") > 1
    assert size(plot(400.0), "naive") > size(plot(400.0), "dynamic") > size(plot(400.0), "adaptive")


def test_a_study_keeps_its_names_from_version_to_version():
    """A plot is told as fieldmon 0.1 told it, chunks as since jumps count once (version 4)."""
    assert SQUARE.digest == "ab915b8df166c3772975"
    asked = Design(samplers=("naive", "adaptive"), hours=(1.0, 3.0), n_days=40, n_seeds=4000)
    chunks = {chunk.key: chunk for chunk in study_of([SQUARE], asked).chunks()}
    for sampler, hours, seeds, digest in (
        ("naive", 1.0, range(1, 328), "3d951a8fb507156745d6"),
        ("naive", 3.0, range(3925, 4001), "8b0fb0e47ec075980208"),
        ("adaptive", 3.0, range(638, 729), "81d669d5e86c38adc966"),
    ):
        chunk = chunks[sampler, digest]
        assert (chunk.setting[1].hours, chunk.seeds) == (hours, seeds)


def test_another_plot_setting_or_seed_has_other_keys():
    def keys(one, asked):
        return {chunk.key for chunk in study_of([one], asked).chunks()}

    base = keys(plot(), SMALL)
    assert base == keys(plot(), SMALL)
    record = Records.of(np.array([(5.0, 45.0)]), np.array([PRESENT]))
    heard = StudyPlot(plot().field, Planting(), record, DAY)
    for other in (plot(41.0), plot(name="other"), heard):
        assert not base & keys(other, SMALL)
    assert not base & keys(plot(), Design(hours=(1.0, 3.0), n_days=5, n_seeds=60))


@pytest.mark.parametrize(
    "settings",
    [
        {"samplers": ("best",)},
        {"hours": ()},
        {"n_days": 0},
        {"n_seeds": 0},
        {"first_seed": -1},
        {"infested": (0.0,)},
        {"spread": (1, 1)},
    ],
)
def test_impossible_designs_are_refused(settings):
    with pytest.raises(SettingError):
        Design(**settings)


def test_one_seed_and_one_day_are_enough():
    alone = Design(("naive",), n_days=1, n_seeds=1)
    assert (alone.n_days, alone.n_seeds, alone.first_seed) == (1, 1, alone.first_seed)
    assert Design(first_seed=0).first_seed == 0
