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


def test_a_season_may_be_treated_by_a_rule_and_says_what_that_came_to(run):
    words = ["simulate", ZIP, "--feature", "Nursery", "--days", 3, "--sampler", "naive"]
    plain = run(*words)[1]
    code, out, err, _ = run(*words, "--treat-from", 0.001, "--treat", "whole")
    assert code == 0, err
    assert "ha sprayed on 1 evening:" in out
    assert "altogether" not in plain
    code, _, err, _ = run(*words, "--treat-from", 0.01, "--treat", "half")
    assert code == 2
    assert "'zones' or 'whole'" in err
