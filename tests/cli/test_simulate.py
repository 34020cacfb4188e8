"""`fieldmon simulate`: seasons on a plot."""

from tests.cli.estate import ZIP


def test_a_season_is_simulated_and_its_table_written(run, tmp_path):
    words = ["simulate", ZIP, "--feature", "Nursery", "--days", 3, "-o", "season.csv"]
    code, out, err, _ = run(*words)
    assert code == 0, err
    lines = (tmp_path / "season.csv").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 1 + 3 * 3
    assert all(name in out for name in ("naive", "bouncy", "dynamic"))
    run(*words[:-1], "again.csv")
    assert (tmp_path / "again.csv").read_text(encoding="utf-8").splitlines() == lines
