"""What a study compares, and the names of its chunks, which stand in folders of studies."""

from dataclasses import replace

import numpy as np
import pytest
from shapely import MultiPolygon, box

from fieldmon.errors import SettingError
from fieldmon.infestation.observations import Observations
from fieldmon.plot.field import Field
from fieldmon.plot.layout import Planting
from fieldmon.simulation.design import Design, Site, chunks

FIELD = Field("Gate", MultiPolygon([box(35.15, 30.36, 35.1508, 30.3607)]), gate=(35.15, 30.36))
RECORDS = Observations.of(
    np.array([[35.1501, 30.3601], [35.1502, 30.3602]]),
    np.array([1, 0], np.int8),
    np.array(["2026-04-01", "NaT"], "datetime64[D]"),
    count=np.array([3.0, np.nan]),
)
SITE = Site(FIELD, Planting(), RECORDS, np.datetime64("2026-04-06"))


def test_a_plot_and_its_chunks_have_the_names_that_studies_on_disk_hold():
    assert SITE.digest == "211317bf7704c67ac766"
    assert [chunk.key for chunk in chunks((SITE,), Design(n_seeds=2, n_days=3))] == [
        "a6777031b32fe8cebe0a",
        "85078e867ce807682209",
        "9e04711db44acbc5bfe3",
    ]


def test_any_other_plot_or_design_has_other_chunks():
    design = Design(n_seeds=2, n_days=3)
    keys = {chunk.key for chunk in chunks((SITE,), design)}
    sites = [
        replace(SITE, observations=RECORDS.take(np.array([0]))),
        replace(SITE, day=SITE.day + 1),
    ]
    for site in sites:
        assert keys.isdisjoint(chunk.key for chunk in chunks((site,), design))
    for other in (replace(design, n_days=4), replace(design, first_seed=5)):
        assert keys.isdisjoint(chunk.key for chunk in chunks((SITE,), other))


def test_chunks_hold_every_seed_of_every_case_once():
    design = Design(hours=(4.0, 8.0), n_seeds=700, first_seed=3)
    listed = list(chunks((SITE,), design))
    for case in design.cases:
        seeds = [s for c in listed if c.case == case for s in range(*c.seeds)]
        assert seeds == list(range(3, 703))


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"samplers": ("best",)}, "must be one of"),
        ({"hours": ()}, "one value of hours"),
        ({"look_s": (20.0, 20.0)}, "each once"),
        ({"n_days": 0}, "1 day and 1 seed"),
        ({"infested": (1.0,)}, "between 0 and 1"),
    ],
)
def test_an_impossible_design_is_a_sentence(wrong, says):
    with pytest.raises(SettingError, match=says):
        Design(**wrong)
