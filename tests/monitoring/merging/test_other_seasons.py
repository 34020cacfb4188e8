"""A season and other files: whether they are copies of it, of its plot, or stand in its place."""

import shutil

from shapely import MultiPolygon, box

from fieldmon.monitoring import Season
from fieldmon.monitoring.merging.other_seasons import is_another_now, of_one_plot
from fieldmon.plot.field import Field
from fieldmon.plot.plot import Plot
from tests.monitoring.seasons import a_season, a_small_plot, some_results


def test_another_season_in_its_place_is_noticed(season, tmp_path):
    season.record(some_results(season), "x")
    assert not is_another_now(season)
    other = a_season(tmp_path / "other.gpkg", a_small_plot())
    shutil.copyfile(other.path, season.path)
    assert is_another_now(season)
    assert not is_another_now(Season(season.path))


def test_seasons_on_the_same_ground_are_of_one_plot_however_rows_are_laid(path, tmp_path):
    def beside(name, degrees, **laid):
        outline = MultiPolygon([box(35.15 + degrees, 30.36, 35.1508 + degrees, 30.3607)])
        return a_season(tmp_path / f"{name}.gpkg", Plot.of(Field(name, outline, **laid)))

    first, turned = Season(path), beside("turned", 0.0003, row_bearing_deg=30.0)
    wider, next_door = beside("wider", -0.0003, row_spacing_m=6.0), beside("next", 0.0009)
    (said,) = of_one_plot([turned, next_door, wider, first])  # wider and turned meet in the first
    assert said.startswith("turned, wider and season are 3 seasons of one plot: each counts.")
    assert of_one_plot([turned, wider]) == of_one_plot([first, next_door]) == ()
