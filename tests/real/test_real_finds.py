"""Adaptive on mapped plots, beside Dynamic, Naive and random looks."""

import numpy as np

from fieldmon.studies.samplers.mapped_plots import plots_in, table


def test_on_mapped_plots_forty_percent_looks_find_about_what_dynamics_do_or_more(shared):
    plots = plots_in(shared / "plant_maps")
    rows = {(row.name, row.who): row for row in table(plots)}
    names = [each.name for each in plots]
    look = {both: row.per_look[-1] for both, row in rows.items()}
    hour = {both: row.per_hour[-1] for both, row in rows.items() if both[1] != "random"}
    assert len(names) == 9
    lead = np.array([look[name, "adaptive"] - look[name, "dynamic"] for name in names])
    # 216 trees of which a corner is infested: who begins there is ahead, see docs/strategies;
    # where many are infested Adaptive nearly sweeps: it finds less a look, and more an hour
    assert lead.min() > -0.06
    assert (lead > 0.01).sum() >= 4
    times = np.array([hour[name, "adaptive"] / hour[name, "dynamic"] for name in names])
    assert times.min() > 0.91  # citrus 1994: .92; it was .94 before finds were taken as ways
    assert (times > 1.02).sum() >= 5
    over_random = np.array([look[name, "adaptive"] - look[name, "random"] for name in names])
    assert over_random.min() > -0.005  # even on two of citrus
    assert (over_random > 0.01).sum() >= 7


def test_the_maps_hold_as_many_infested_plants_as_their_papers_say(shared):
    plots = [each for each in plots_in(shared / "plant_maps") if each.name.startswith("citrus")]
    assert [each.name[-4:] for each in plots] == ["1991", "1992", "1993", "1994"]
    assert [int(each.infested.sum()) for each in plots] == [44, 76, 127, 136]
    assert all(len(each.infested) == 216 for each in plots)
