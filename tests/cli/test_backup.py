"""`fieldmon backup`: a copy of a season as it is now."""


def test_a_season_is_copied_and_no_file_is_overwritten(run, season):
    code, out, err, made = run("backup", season, "-o", "copy.gpkg")
    assert code == 0, err
    assert {path.name for path in made} == {"copy.gpkg"}
    assert "copy.gpkg is a copy of" in out
    assert run("status", "copy.gpkg")[0] == 0
    code, _, err, made = run("backup", season, "-o", "copy.gpkg")
    assert (code, made) == (2, set())
    assert "exists already" in err
