"""What the app keeps between clicks, all sessions together."""

import numpy as np

from app.state import cached, cached_files, cached_simulations
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.infestation.records import Records
from fieldmon.planning.plan import PlanSettings, plan_from
from fieldmon.planning.wishes import Wishes
from fieldmon.plot.robot import Robot
from tests.app.chosen import a_plot
from tests.app.driving import go, metric, opened, tap
from tests.monitoring.seasons import a_season

PRIOR, NOTHING = PriorSettings(), (Records.none(), None)


def test_two_windows_on_one_season_see_each_other(season_app):
    other = opened("Gate 2026")
    go(season_app, "scout")
    tap(season_app, "scout_found")
    go(other, "season")
    assert metric(other, "Found") == "1"


def test_who_waits_is_told_so_in_our_words_or_not_at_all():
    """Streamlit's own are the name of a function, and take a thread each."""
    modules = (cached, cached_files, cached_simulations)
    kept = {name: one for module in modules for name, one in vars(module).items()
            if hasattr(one, "_info")}  # fmt: skip
    assert len(kept) > 40
    assert [name for name, one in kept.items() if one._info.show_spinner is True] == []


def test_plots_that_differ_in_one_plant_are_kept_apart_by_their_keys():
    """Streamlit hashes a sample of an array: plants must not be what a value is kept by."""
    plot = a_plot()
    other = plot.without(np.arange(len(plot.grid)) == 7)
    kept = [cached.chance_map(f"plot {k}", "2026-11-16", PRIOR, one, NOTHING)
            for k, one in enumerate((plot, other))]  # fmt: skip
    assert len(kept[0]) == len(kept[1]) + 1
    again = cached.chance_map("plot 0", "2026-11-16", PRIOR, other, NOTHING)
    assert again is kept[0]


def test_what_is_believed_of_a_morning_is_worked_out_once_for_all_hours():
    plot = a_plot()
    short, day = (
        cached.day_plan(
            "one morning", "2026-11-16", PlanSettings(Robot(hours=hours), prior=PRIOR),
            "adaptive", plot, NOTHING, Wishes(),
        )
        for hours in (0.2, 2.0)
    )  # fmt: skip
    assert short.scene.pair_chance is day.scene.pair_chance
    anew = plan_from(plot, day.scene.chance, PlanSettings(Robot(hours=2.0), prior=PRIOR))
    assert len(short.route) < len(day.route)
    assert day.route.plant.tolist() == anew.route.plant.tolist()


def test_a_season_that_was_replaced_by_another_of_its_name_is_opened_anew(tmp_path):
    path = tmp_path / "s.gpkg"
    a_season(path)
    first = cached.season(path)
    assert cached.season(path) is first
    path.rename(tmp_path / "kept.gpkg")  # its inode stays taken
    a_season(path)
    assert cached.season(path) is not first


def test_layers_are_made_once_for_a_key():
    made = []
    for key in ("a", "a", "b"):
        cached.layers(f"test {key}", lambda key=key: [*made, made.append(key)])
    assert made == ["a", "b"]
