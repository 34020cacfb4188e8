"""`fieldmon change`: a season goes on otherwise."""

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
