"""A plot in figures: its area, and how it is planted."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from app.show import plot_figures
from app.words.units import UnitsInLanguage
from fieldmon.io.parse.geometry import area_m2
from fieldmon.plot.plot import Plot
from tests.app.chosen import a_plot
from tests.app.driving import apart


class Metrics(dict):
    def __call__(self, label, value, **_):
        self[label] = apart(value) if isinstance(value, str) else value


@pytest.fixture
def metrics(monkeypatch):
    shown = Metrics()
    monkeypatch.setattr(plot_figures.st, "metric", shown)
    return shown


def test_figures_are_the_plot_s_in_the_units_chosen(metrics):
    plot = a_plot(row_bearing_deg=200.0, row_spacing_m=5.0, plant_spacing_m=2.0)
    low = plot.field.boundary.bounds[:2]
    shed = shapely.MultiPolygon([shapely.box(*low, *np.add(low, 0.0001))])
    plot = replace(plot, field=replace(plot.field, no_go=shed))
    plot_figures.show(plot, UnitsInLanguage())
    assert metrics == {
        "Area": f"{area_m2(plot.field.boundary) / 1e4:.3f} ha",
        "Plants": f"{len(plot.grid):,}",
        "Rows": plot.grid.n_rows,
        "Row direction": "20.0°",
        "Rows / plants apart": "5.0 m / 2.0 m",
    }
    plot_figures.show(plot, UnitsInLanguage("ft", "dunam"))
    assert metrics["Rows / plants apart"] == "16.4 ft / 6.6 ft"
    assert metrics["Area"].endswith(" dunam")


def test_rows_that_bend_have_no_one_direction(metrics):
    x = np.linspace(0.0, 0.0006, 20)
    rows = [np.stack([35.15 + x, 30.36 + 0.4 * k * x.max() + 200 * x**2], 1) for k in range(3)]
    field = replace(a_plot().field, row_lines=shapely.multilinestrings(rows))
    plot_figures.show(Plot.of(field), UnitsInLanguage())
    assert metrics["Rows"] == 3
    assert "Row direction" not in metrics
