"""`fieldmon study replanning`: three plans on the same insects, in sentences."""

from fieldmon.studies.routes import seasons as studied


def test_the_difference_from_adaptive_is_said_with_its_interval(run, monkeypatch):
    asked = []

    def seasons(scenario, seeds, hours):
        asked.append((scenario.plot, scenario.spread.rate_per_day, hours))
        days = {studied.AS_IT_IS: (4.0, 6.0), studied.MORNING: (11.0, 15.0), studied.BEST: (4, 6)}
        for seed in seeds:
            for who, lost in days.items():
                yield studied.PairedSeason(who, seed, lost[seed], 9)

    monkeypatch.setattr(studied, "seasons", seasons)
    code, out, err, made = run("study", "replanning", "--seeds", "2", "--hours", "3")
    assert (code, made, asked) == (0, set(), [("A", 0.3, 3.0)]), err
    assert out.splitlines() == [
        "adaptive: 5.0 infested plant-days, 9.0 found",
        "adaptive, morning's plan: 13.0 infested plant-days, 9.0 found",
        "  +8.0 (+6.0 to +10.0)",
        "best route, morning's plan: 5.0 infested plant-days, 9.0 found",
        "  +0.0 (+0.0 to +0.0)",
    ]


def test_one_seed_has_no_interval_and_is_refused(run):
    code, _, err, _ = run("study", "replanning", "--seeds", "1")
    assert code == 2
    assert "--seeds" in err
