"""`fieldmon study routes`: a table of methods on reward matrices."""

import csv
from contextlib import contextmanager

from fieldmon.cli import progress, study_routes
from fieldmon.studies.routes.team_walks import team_walks


def test_a_matrix_is_played_by_all_methods(run, tmp_path):
    (tmp_path / "plot.csv").write_text("1,0,3\n0,2,2\n5,0,0\n")
    budgets = ("--budget", 0.4, "--budget", 1)
    code, out, err, made = run("study", "routes", tmp_path / "plot.csv", *budgets, "--milp")
    assert code == 0, err
    assert "plot.csv, 40% of the full budget" in out
    assert "routes.csv" in {path.name for path in made}
    with (tmp_path / "routes.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 2 * 7
    exact = {row["budget"]: float(row["reward"]) for row in rows if row["method"] == "ladder"}
    assert all(float(row["reward"]) <= exact[row["budget"]] for row in rows)
    assert max(exact.values()) == 13


def test_what_cannot_be_read_or_played_is_said_in_a_sentence(run, tmp_path):
    (tmp_path / "bad.csv").write_text("1,x\n")
    for words, said in (
        ((tmp_path / "bad.csv",), "must hold numbers"),
        ((), "A reward matrix or a seed must be given"),
        (("--seed", 1, "--budget", 2), "--budget must be above 0 and 1 at most"),
    ):
        code, _, err, _ = run("study", "routes", *words)
        assert code == 2
        assert said in err


def test_a_team_has_its_lines_and_its_bound(run, tmp_path):
    (tmp_path / "plot.csv").write_text("1,0,3\n0,2,2\n5,0,0\n")
    code, out, err, _ = run(
        *("study", "routes", tmp_path / "plot.csv", "--budget", 0.3, "--team", 2, "--team", 3)
    )
    assert code == 0, err
    assert "team of 2, each 30% of the full budget" in out
    with (tmp_path / "routes.csv").open(encoding="utf-8") as file:
        rows = {row["method"]: row for row in csv.DictReader(file)}
    assert float(rows["ladder"]["reward"]) <= float(rows["team of 2"]["reward"])
    assert float(rows["team of 3"]["reward"]) <= float(rows["team of 3"]["bound"]) <= 13


def test_a_teams_search_moves_the_bar_before_it_ends(run, tmp_path, monkeypatch):
    (tmp_path / "plot.csv").write_text("1,0,3\n0,2,2\n5,0,0\n")
    bars, moved = [], []

    @contextmanager
    def watched(label, length):
        with progress.progress(label, length) as bar:
            bars.append(bar)
            yield bar

    def searched(reward, budget, size, tell):
        before = bars[0].pos
        for share in (0.0, 0.5, 1.0):
            tell(share)
            moved.append(bars[0].pos - before)
        return team_walks(reward, budget, size)

    monkeypatch.setattr(study_routes, "progress", watched)
    monkeypatch.setattr("fieldmon.studies.routes.study.team_walks", searched)
    code, _, err, _ = run(
        *("study", "routes", tmp_path / "plot.csv", "--budget", 0.3, "--team", 2, "--team", 3)
    )
    assert code == 0, err
    assert moved == [0, 49, 99] * 2
    assert bars[0].pos == bars[0].length


def test_a_study_that_is_stopped_keeps_what_was_done(run, tmp_path, monkeypatch):
    (tmp_path / "plot.csv").write_text("1,0,3\n0,2,2\n5,0,0\n")

    def stopped(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("fieldmon.studies.routes.study.team_walks", stopped)
    code, out, err, _ = run(
        *("study", "routes", tmp_path / "plot.csv", "--budget", 0.3, "--team", 2)
    )
    assert code == 0, err
    assert "Stopped: this is what was done." in out
    with (tmp_path / "routes.csv").open(encoding="utf-8") as file:
        assert next(csv.DictReader(file))["method"] == "ladder"


def test_a_study_that_is_stopped_at_once_writes_nothing(run, tmp_path, monkeypatch):
    (tmp_path / "plot.csv").write_text("1,0,3\n0,2,2\n5,0,0\n")

    def stopped(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("fieldmon.studies.routes.study.best_walk", stopped)
    code, _, err, made = run("study", "routes", tmp_path / "plot.csv")
    assert code == 130
    assert "Stopped" in err
    assert "routes.csv" not in {path.name for path in made}
