"""`fieldmon export`: a season's record for others."""

import json

import numpy as np

from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from fieldmon.monitoring import Season
from tests.cli.estate import BEGINS, table


def test_tables_and_observations_are_written_or_refused(run, season, tmp_path):
    code, _, err, made = run("export", season, "-o", "none.csv")
    assert (code, made) == (2, set())
    assert "There must be treatments to write" in err
    run("treat", season, "--efficacy", "0.5", "--date", BEGINS, "--product", "=soap")
    Season(season).record(
        Inspections.of(np.array([3, 4]), np.array([FOUND, CLEAN]), np.datetime64(BEGINS)), "taps"
    )
    for of, n in (("treatments", 1), ("inspections", 2), ("log", 3)):
        code, _, err, _ = run("export", season, "--of", of, "-o", f"{of}.csv")
        assert code == 0, err
        assert len(table(tmp_path / f"{of}.csv")) == n
    assert "'=soap" in (tmp_path / "treatments.csv").read_text("utf-8-sig")
    code, _, err, _ = run("export", season, "-o", "seen.json")
    assert code == 2
    assert "must be an EPPO code" in err
    code, _, err, _ = run("export", season, "-o", "s.json", "--pest", "TETRUR", "--crop", "lypes")
    assert code == 0, err
    assert len(json.loads((tmp_path / "s.json").read_text())["fieldObservations"]) == 2
    code, _, err, _ = run("export", season, "-o", "seen.xlsx")
    assert code == 2
    assert "must end in .csv or .json" in err
