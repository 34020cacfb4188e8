"""`fieldmon change`: a season goes on otherwise."""

from fieldmon.cli.status import lines
from fieldmon.monitoring import Season


def test_choices_can_be_changed(run, season):
    code, _, err, _ = run("change", season, "--sampler", "snake", "--every", 2, "--hours", "0.5")
    assert code == 0, err
    settings = Season(season).settings
    assert (settings.sampler, settings.sampler_settings, settings.robot.hours) == (
        "snake",
        {"every": 2},
        0.5,
    )
    assert "Nothing" in run("change", season)[1]
    code, out, err, _ = run("undo", season, "--change")
    assert code == 0, err
    assert "adaptive, 1 h" in out
    assert Season(season).settings.robot.hours == 1.0
    code, _, err, _ = run("undo", season, "--change")
    assert (code, "there is none" in err) == (2, True)


def test_a_season_is_charged_the_times_that_are_chosen(run, season):
    assert Season(season).settings.robot.times == "measured"
    code, _, err, _ = run("change", season, "--robot-times", "thesis")
    assert code == 0, err
    assert Season(season).settings.robot.times == "thesis"


def test_finds_are_traced_or_not_as_is_chosen(run, season):
    assert Season(season).settings.belief.traces
    code, _, err, _ = run("change", season, "--no-trace", "--spread", "0.03")
    assert code == 0, err
    kept = Season(season)
    assert not kept.settings.belief.traces
    assert kept.settings.belief.spread.rate_per_day == 0.03
    said = "\n".join(lines(kept, kept.status(kept.last_date())))
    assert "to neighbours only" in said
    assert "detection" not in said


def test_whether_finds_are_treated_or_only_flagged_is_chosen(run, season):
    for option, treated in (("--flag-only", False), ("--treat-finds", True)):
        code, _, err, _ = run("change", season, option)
        assert code == 0, err
        assert Season(season).settings.belief.treated is treated
