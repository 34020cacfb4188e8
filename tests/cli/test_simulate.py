"""`fieldmon simulate`: seasons on a plot."""

from tests.cli.estate import ZIP


def test_a_season_is_simulated_and_its_table_written(run, tmp_path):
    words = ["simulate", ZIP, "--feature", "Nursery", "--days", 3, "-o", "season.csv"]
    code, out, err, _ = run(*words)
    assert code == 0, err
    lines = (tmp_path / "season.csv").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 1 + 3 * 3
    assert all(name in out for name in ("naive", "bouncy", "dynamic"))
    # a table that is simulated again is no sheet that somebody filled in
    assert run(*words)[0] == 0
    run(*words[:-1], "again.csv")
    assert (tmp_path / "again.csv").read_text(encoding="utf-8").splitlines() == lines


def test_where_nothing_was_infested_no_share_was_found(run, tmp_path):
    words = ["simulate", ZIP, "--feature", "Nursery", "--days", 1, "--sampler", "naive"]
    code, out, err, _ = run(*words, "--infested", 1e-9, "-o", "season.csv")
    assert code == 0, err
    assert out.splitlines()[-2].split()[:2] == ["1", "-"]
    assert (tmp_path / "season.csv").read_text(encoding="utf-8").splitlines()[1][:9] == "naive,1,,"


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


def test_visits_may_be_days_apart_and_are_told_from_days(run, tmp_path):
    words = ["simulate", ZIP, "--feature", "Nursery", "--days", 5, "--sampler", "naive"]
    plain = run(*words, "-o", "plain.csv")[1]
    run(*words, "--visit-every", 1, "-o", "daily.csv")
    daily = (tmp_path / "daily.csv").read_text(encoding="utf-8")
    assert daily == (tmp_path / "plain.csv").read_text(encoding="utf-8")
    assert "visits" not in plain
    code, out, err, _ = run(*words, "--visit-every", 3, "-o", "apart.csv")
    assert code == 0, err
    assert "2 visits in 5 days, " in out
    assert "plants inspected a visit" in out
    head, *rows = (tmp_path / "apart.csv").read_text(encoding="utf-8").splitlines()
    assert head.endswith(",infested_left,visit,hours")
    assert [row.split(",")[-2] for row in rows] == ["1", "", "", "2", ""]
    # the first visit is that of a season with one a day
    assert rows[0].startswith(daily.splitlines()[1])
    code, _, err, _ = run(*words, "--visit-every", 0)
    assert (code, "--visit-every must be 1 or more" in err) == (2, True)
