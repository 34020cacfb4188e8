"""From a session's files to a plot."""

import pytest

from tests.app.driving import go, heading, layer, square, upload, zipped


def test_an_uploaded_plot_and_records_are_planned(app, tmp_path):
    mites = b"date,lon,lat,count\n2026-11-10,35.1505,30.3605,9\n"
    plot = zipped(tmp_path, square(name="שדה"))
    upload(app, plot=("plot.zip", plot), record=("mites.csv", mites))
    assert not app.exception
    assert heading(app).startswith("שדה")
    go(app, "today")
    worst = max(layer(app, "plants")["data"], key=lambda p: float(p["t"].split(": ")[1][:-8]))
    assert worst["p"] == pytest.approx([35.1505, 30.3605], abs=4e-5)
