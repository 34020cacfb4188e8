"""CSV as spreadsheets take it, out and back filled in."""

import csv
from datetime import timedelta

import numpy as np
import pandas as pd
import pytest

from fieldmon.infestation.inspections import CLEAN, FOUND
from fieldmon.io.options import Upload
from fieldmon.io.readers.inspections import read_inspections
from fieldmon.io.writers import write_handoff
from fieldmon.plot.layout import rectangle
from tests.io.writers.handed import CM, START, apart_m, crooked, day, usual


def test_csv_is_what_spreadsheets_take_for_utf_8_with_one_line_a_stop(tmp_path, plan):
    (path,) = write_handoff(plan, tmp_path / "route.csv")
    data = path.read_bytes()
    assert data.startswith(b"\xef\xbb\xbf")
    assert data.count(b"\n") == data.count(b"\r\n") == 1 + len(plan.route)  # RFC 4180
    with path.open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    assert all(None not in row and None not in row.values() for row in rows)
    assert [int(row["stop"]) for row in rows] == list(range(1, len(rows) + 1))
    assert [int(row["plant"]) for row in rows] == plan.route.plant.tolist()
    lonlat = [(float(row["lon"]), float(row["lat"])) for row in rows]
    assert apart_m(lonlat, plan.route.stops_lonlat()) < CM
    assert {row["plot"] for row in rows} <= {plan.notes.plot}
    assert all(row[k] == "" for row in rows for k in ("found", "count", "who", "notes"))
    arrivals = [START + timedelta(seconds=round(s)) for s in plan.route.arrive_s]
    assert [row["arrive"] for row in rows] == [at.isoformat() for at in arrivals]


def test_a_plot_whose_name_is_a_formula_does_not_become_one(tmp_path):
    plan = day(rectangle(3, 4), plot="=HYPERLINK(1)\n\x00")
    (path,) = write_handoff(plan, tmp_path / "route.csv")
    with path.open(encoding="utf-8-sig", newline="") as file:
        assert next(csv.DictReader(file))["plot"].startswith("'=")


@pytest.mark.parametrize("make", [usual, crooked])
def test_the_csv_comes_back_filled_in(tmp_path, make):
    plan = make()
    (path,) = write_handoff(plan, tmp_path / "route.csv")
    table = pd.read_csv(path, dtype={"found": object, "who": object})
    table.loc[0, ["found", "count"]] = "yes", 4
    table.loc[2, "found"] = "no"
    for data in (table.to_csv(index=False).encode(), table.to_csv(index=False, sep=";").encode()):
        findings = read_inspections(Upload("route.csv", data), plan.grid).value
        assert findings.plant.tolist() == plan.route.plant[[0, 2]].tolist()
        assert findings.result.tolist() == [FOUND, CLEAN]
        assert findings.date.astype(str).tolist() == ["2026-11-18"] * 2
        assert np.isnan(findings.second).all()
