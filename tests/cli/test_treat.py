"""`fieldmon treat`: a plot was sprayed."""

from datetime import date

import numpy as np
import pytest

from fieldmon.monitoring import Season
from tests.cli.estate import BEGINS, filled_in


def test_undo_and_treat(run, season, tmp_path):
    run("plan", season, "--date", BEGINS, "-o", "r.csv")
    filled_in(tmp_path / "r.csv", finds={0}, n=5)
    before = Season(season).evening(date.fromisoformat(BEGINS))
    run("record", season, "r.csv", "--date", BEGINS)
    code, out, _, _ = run("undo", season)
    assert (code, "5 findings from r.csv" in out) == (0, True)
    assert np.array_equal(Season(season).evening(date.fromisoformat(BEGINS)), before)
    code, out, err, _ = run("treat", season, "--efficacy", "0.5", "--date", BEGINS)
    assert code == 0, err
    assert Season(season).evening(date.fromisoformat(BEGINS)) == pytest.approx(before / 2)
    code, out, _, _ = run("treat", season, "--efficacy", "0.5", "--date", BEGINS)
    assert "nothing changed" in out
