"""`fieldmon salvage`: what is left of a damaged season."""


def test_a_damaged_season_is_salvaged(run, season):
    data = season.read_bytes()
    season.write_bytes(data[: len(data) * 19 // 20])
    code, _, err, _ = run("status", season)
    if code:
        assert "salvage" in err
    code, out, err, made = run("salvage", season, "-o", "rescued.gpkg")
    assert code == 0, err
    assert {path.name for path in made} == {"rescued.gpkg"}
    assert "plants" in out
