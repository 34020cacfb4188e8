"""Adaptive on mapped plots, beside Dynamic, Naive and random looks."""

import numpy as np

from fieldmon.studies.samplers.mapped_plots import LAYOUTS, maps_from, table


def test_on_mapped_plots_forty_percent_looks_find_about_what_dynamics_do_or_more(shared):
    folder = shared / "plant_maps"
    maps = [m for name in LAYOUTS for m in maps_from(name, (folder / name).read_text())]
    at_40 = {(name, who): values[-1] for name, who, values in table(maps)}
    names = [m.name for m in maps]
    lead = np.array([at_40[name, "adaptive"] - at_40[name, "dynamic"] for name in names])
    assert len(names) == 9
    # 216 trees of which a corner is infested: who begins there is ahead, see docs/strategies
    assert lead.min() > -0.05
    assert (lead > 0.01).sum() >= 4
    assert all(at_40[name, "adaptive"] > at_40[name, "random"] for name in names)


def test_the_maps_hold_as_many_infested_plants_as_their_papers_say(shared):
    text = (shared / "plant_maps" / "citrus_ctv_IVI3and4.csv").read_text()
    maps = maps_from("citrus_ctv_IVI3and4.csv", text)
    assert [int(m.infested.sum()) for m in maps] == [44, 76, 127, 136]
    assert all(len(m.infested) == 216 for m in maps)
