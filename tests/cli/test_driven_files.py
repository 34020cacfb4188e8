"""What is written of a driven day, and what is never written over."""

from tests.cli.estate import BEGINS, ZIP, filled_in

PLOT = ("drive", ZIP, "--feature", "Nursery", "--hours", "0.3", "--date", BEGINS)


def test_a_sheet_that_was_filled_in_is_not_written_over_by_a_season_that_is_driven(
    run, season, tmp_path
):
    run("plan", season, "--date", BEGINS, "--no-bound", "-o", "day.csv")
    filled_in(tmp_path / "day.csv", {0}, 1)
    held, kept = (tmp_path / "day.csv").read_bytes(), season.read_bytes()
    code, _, err, made = run("drive", season, "--date", BEGINS, "--made-up", "-o", "day.csv")
    assert (code, made) == (2, set())
    assert "day.csv would be written over, but it was filled in and holds 1 result" in err
    assert ((tmp_path / "day.csv").read_bytes(), season.read_bytes()) == (held, kept)
    run("change", season, "--robots", "2")
    (tmp_path / "day.csv").rename(tmp_path / "day-robot-2.csv")
    words = ("--robot", "vda5050", "--broker", "127.0.0.1:1", "-o", "day.csv")
    code, _, err, made = run("drive", season, "--date", BEGINS, *words)
    assert (code, made) == (2, set())
    assert "day-robot-2.csv would be written over, but it was filled in" in err
    assert (tmp_path / "day-robot-2.csv").read_bytes() == held


def test_a_driven_day_writes_over_its_own_tables_only(run, tmp_path):
    sheet = tmp_path / "day.stops.csv"
    sheet.write_text("order,row,number,found\n1,1,1,yes\n")
    code, _, err, made = run(*PLOT, "-o", "day.csv")
    assert (code, made) == (2, set())
    assert "day.stops.csv would be written over, but was filled in" in err
    sheet.unlink()
    for _ in range(2):
        code, _, err, _ = run(*PLOT, "-o", "day.csv")
        assert code == 0, err
    code, _, err, _ = run(*PLOT, "-o", "nowhere/day.csv")
    assert code == 2
    assert "The folder nowhere must exist" in err
