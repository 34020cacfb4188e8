"""`fieldmon study spread`: mapped plots foretold from date to date."""

import numpy as np


def test_a_map_of_two_dates_is_scored(run, tmp_path):
    draws = np.random.default_rng(1)
    before = draws.random((12, 12)) < 0.1
    after = before | (draws.random((12, 12)) < 0.15)
    rows = [
        f"{x + 1},{y + 1},{t},{int(state[y, x])},1"
        for t, state in ((1991, before), (1992, after)) for y in range(12) for x in range(12)
    ]  # fmt: skip
    (tmp_path / "citrus_ctv_IVI3and4.csv").write_text("\n".join(["x,y,t,i,n", *rows]))
    (tmp_path / "north.csv").touch()
    code, out, err, _ = run("study", "spread", str(tmp_path))
    assert code == 0, err
    assert "Not read as a map: north.csv (1)." in err
    assert "1991 to 1992" in out
    assert "the thesis's rule" in out


def test_a_folder_without_maps_is_told(run, tmp_path):
    code, _, err, _ = run("study", "spread", str(tmp_path))
    assert code != 0
    assert "must hold a map of plants" in err


def test_maps_between_whose_dates_nothing_happens_are_told(run, tmp_path):
    rows = [f"1,{p},{int(p == 1)},2,1,{t}" for t in (1, 2) for p in range(1, 21)]
    head = "row,plant,infested,row_m,plant_m,date"
    (tmp_path / "vines.map.csv").write_text("\n".join([head, *rows]))
    code, out, err, _ = run("study", "spread", str(tmp_path))
    assert (code, out) == (2, "")
    assert "must have two dates" in err
    assert err.rstrip().endswith("None of these has: vines.")
