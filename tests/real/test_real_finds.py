"""Adaptive on mapped plots, beside Dynamic, Naive and random looks."""

import numpy as np

from fieldmon.studies.samplers.mapped_plots import plots_in, table


def test_on_mapped_plots_forty_percent_looks_find_about_what_dynamics_do_or_more(shared):
    plots = plots_in(shared / "plant_maps")
    at_40 = {(row.name, row.who): row.per_look[-1] for row in table(plots)}
    names = [each.name for each in plots]
    lead = np.array([at_40[name, "adaptive"] - at_40[name, "dynamic"] for name in names])
    assert len(names) == 9
    # 216 trees of which a corner is infested: who begins there is ahead, see docs/strategies
    assert lead.min() > -0.05
    assert (lead > 0.01).sum() >= 4
    assert all(at_40[name, "adaptive"] > at_40[name, "random"] for name in names)


def test_the_maps_hold_as_many_infested_plants_as_their_papers_say(shared):
    plots = [each for each in plots_in(shared / "plant_maps") if each.name.startswith("citrus")]
    assert [each.name[-4:] for each in plots] == ["1991", "1992", "1993", "1994"]
    assert [int(each.infested.sum()) for each in plots] == [44, 76, 127, 136]
    assert all(len(each.infested) == 216 for each in plots)
