"""`fieldmon log`: what happened, and that it still holds."""

from fieldmon.errors import FileProblem
from fieldmon.monitoring import Season
from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.estimates import verifying
from fieldmon.monitoring.inspecting import batches
from tests.cli.estate import BEGINS
from tests.monitoring.changes.test_season_log import by_hand


def test_the_log_is_shown_and_a_changed_past_is_refused(run, season):
    run("treat", season, "--efficacy", "0.5", "--date", BEGINS, "--operator", "Ann")
    code, out, err, _ = run("log", season)
    assert code == 0, err
    assert "begins" in out
    assert "Ann" in out
    assert "2 entries, the chain holds; the last digest is" in out
    by_hand(season, "UPDATE treatments SET product = 'water'")
    code, _, err, _ = run("log", season)
    assert code == 2
    assert "Row 1 of the layer treatments is not what was recorded." in err
    by_hand(season, "UPDATE log SET entry = replace(entry, 'Ann', 'Eve') WHERE fid = 2")
    code, out, err, _ = run("log", season)
    assert (code, out) == (2, "")
    assert "entry 2 is not what was written" in err


def test_the_log_shows_the_times_of_the_plot_as_batches_do(run, season, monkeypatch):
    monkeypatch.setattr(season_log, "utc_text", lambda: "2026-12-31T22:30:00.000000Z")
    monkeypatch.setattr(batches, "utc_text", lambda: "2026-12-31T22:30:00.000000Z")
    run("treat", season, "--efficacy", "0.5", "--date", BEGINS)
    assert "2027-01-01T00:30  treated" in run("log", season)[1]
    assert "2027-01-01 00:30      1 treatment" in run("status", season, "--batches")[1]


def test_entries_are_shown_before_any_morning_is_worked_out_again(run, season, monkeypatch):
    def fails(*_, **__):
        raise FileProblem("no morning was worked out")

    monkeypatch.setattr(verifying, "changed_maps", fails)
    code, out, err, _ = run("log", season)
    assert code == 2
    assert "1 entry, the chain holds" in out
    assert "no morning was worked out" in err


def test_of_a_long_season_only_the_last_mornings_are_held_to_their_digests_and_that_is_said(
    run, season, monkeypatch
):
    for on in range(1, 4):
        assert (
            run("plan", season, "--no-bound", "--date", BEGINS[:-1] + str(int(BEGINS[-1]) + on))[0]
            == 0
        )
    by_hand(season, "UPDATE days SET digest = 'other' WHERE day = 0")
    only_last = "the last mornings only; fieldmon log --mornings"
    for command in ("log", "status"):
        _, _, short, _ = run(command, season)
        with monkeypatch.context() as patched:
            patched.setattr(verifying, "SHORT", 0)
            code, _, long, _ = run(command, season)
            _, _, asked, _ = run("log", season, "--mornings")
        assert code == 0
        told = [f"chance map of {BEGINS}" in err for err in (short, long, asked)]
        assert told == [True, False, True]
        assert [only_last in err for err in (short, long, asked)] == [False, True, False]


def test_what_was_advised_is_in_the_log_once(run, season):
    for _ in range(2):
        code, out, err, _ = run("decide", season, "--threshold", "5%", "--date", BEGINS)
        assert code == 0, err
    (one,) = (entry for entry in Season(season).log() if entry.kind == "advised")
    assert one.what["date"] == BEGINS
    assert one.what["said"].split(":")[0] in out
