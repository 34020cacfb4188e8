"""Advice: one answer in one sentence, the looks that it lacks, and zones that can be written."""

import re
from dataclasses import replace
from datetime import timedelta
from types import SimpleNamespace

import numpy as np
import pytest

from fieldmon.compute.wording import counted
from fieldmon.decisions.sequential import INSPECT_MORE, LEAVE, TREAT
from fieldmon.decisions.sprayer import Sprayer, TreatmentCosts
from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import SKIPPED, Inspections
from fieldmon.infestation.records import Records
from fieldmon.monitoring import MonitoringSettings, Season
from fieldmon.monitoring.advice.advice import Advice
from fieldmon.monitoring.settings.advice_settings import AdviceSettings
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from tests.monitoring.seasons import BEGINS, a_plot, a_season, of_a_corner

CHEAP = TreatmentCosts(per_ha=20.0, per_zone=0.1)


@pytest.fixture(scope="module")
def season(tmp_path_factory):
    """Return a season in which a corner of the plot was found infested, and nothing else."""
    return of_a_corner(tmp_path_factory.mktemp("advice") / "season.gpkg")


def test_where_nobody_has_inspected_there_is_no_verdict(tmp_path):
    """Whatever was told; skipped plants are no inspections."""
    made = a_season(tmp_path / "season.gpkg")
    made.record(Inspections.of(np.arange(5), np.full(5, SKIPPED), np.datetime64(BEGINS)), "day")
    for level in (0.9, 1e-6):
        advice = made.advice(BEGINS, AdviceSettings(level, costs=CHEAP))
        assert advice.verdict == made.verdict(BEGINS, level).verdict == INSPECT_MORE
        assert advice.headline().startswith("Keep inspecting before you decide: nobody has")
        assert advice.reasons()[1].startswith("Nobody has inspected yet: the answer rests on")
        assert {one.verdict for one in advice.said.zones} <= {INSPECT_MORE}
    made.record(Inspections.of(np.arange(5), np.zeros(5), np.datetime64(BEGINS)), "day")
    assert made.verdict(BEGINS, 0.9).verdict == LEAVE


def test_faces_are_counted_by_the_advice_as_by_the_status_and_that_is_said(season, tmp_path):
    """What was found on second faces alone counts in each figure of the same answer."""
    two = a_season(
        tmp_path / "two.gpkg", plot=a_plot(faces=2), belief=BeliefSettings(treated=False)
    )
    grid = two.plot.grid
    second = np.flatnonzero(grid.vine != np.arange(len(grid)))[:40]
    found = (np.arange(40) < 10).astype(int)
    two.record(Inspections.of(second, found, np.datetime64(BEGINS)), "day")
    advice, status = two.advice(BEGINS, AdviceSettings(0.05, costs=CHEAP)), two.status(BEGINS)
    assert advice.zones.treated[second[found == 1]].all()
    infested = pytest.approx(status.infested.expected)
    assert advice.zones.inside + advice.zones.outside == infested
    assert advice.plot.share * status.plants == infested
    two.treat(BEGINS, 0.5, plants=np.isin(grid.vine, grid.vine[second[:6]]), product="soap")
    treated = two.advice(BEGINS, AdviceSettings(0.05, costs=CHEAP))
    assert any(one.startswith("6 plants were treated that day") for one in treated.reasons())
    assert two.contents([(last := two.batches()[0]).number])[last.number].n == 6
    assert two.log()[-1].what["said"].startswith("soap on 72 m²")
    assert ", 6 plants in row" in two.log()[-1].what["said"]
    said = "Each face counts as a plant"
    assert said in advice.said_of_zones()[-1]
    assert said not in " ".join(season.advice(BEGINS).sentences())


def test_a_corner_is_treated_and_not_the_plot(season):
    asked = AdviceSettings(0.15, costs=replace(CHEAP, per_ha=30.0))
    advice = season.advice(BEGINS, asked)
    assert advice.verdict == season.verdict(BEGINS, 0.15).verdict == "do not treat"
    assert advice.above >= 1
    assert advice.headline().startswith("Do not treat the whole plot, but ")
    corner = season.plot.grid.xy_m[advice.zones.treated] - season.plot.grid.xy_m.min(axis=0)
    # the rows in which finds lay may go on
    assert np.median(corner.max(axis=1)) <= 24
    assert len(corner) < len(season.plot.grid) / 4
    assert advice.saving > 0.0
    assert "The chance that it is enough is" in " ".join(advice.sentences())


@pytest.mark.parametrize(("level", "said"), [(0.01, "Treat "), (0.9, "Do not treat")])
def test_the_headline_is_the_answer(season, level, said):
    asked = AdviceSettings(level, costs=CHEAP)
    assert season.advice(BEGINS, asked).headline().startswith(said)


@pytest.mark.parametrize("level", [0.4, 0.99])
def test_a_plot_that_is_left_is_inspected_again_before_it_may_be_above_the_threshold(season, level):
    advice = season.advice(BEGINS, AdviceSettings(level, costs=CHEAP))
    ahead, infested = season.forecast(BEGINS), level * len(season.plot.grid)
    above = [night for night in range(1, 15) if ahead.high[night] > infested]
    assert advice.again.by == (BEGINS + timedelta(days=above[0]) if above else None)
    said = advice.reasons()[1]
    if above:
        assert said.startswith(f"Inspect again by {advice.again.by}: before, it stays below")
    else:
        assert said.startswith("Without inspections it stays below the threshold for 14 nights")
    assert season.advice(BEGINS, AdviceSettings(0.01, costs=CHEAP)).again is None


def test_a_plot_that_is_left_says_where_nobody_has_inspected(tmp_path):
    made = a_season(tmp_path / "season.gpkg")
    asked = AdviceSettings(0.5, costs=CHEAP)
    said = "Nobody has inspected yet: the answer rests on what was told before."
    assert said in made.advice(BEGINS, asked).reasons()
    grid = made.plot.grid
    made.record(Inspections.of([0, 1, 2], [0, 0, 2], np.datetime64(BEGINS)), "day")
    advice = made.advice(BEGINS, asked)
    reach_m = 12 * np.sqrt(grid.row_spacing_m * grid.plant_spacing_m)
    away = np.hypot(*(grid.xy_m[:, None] - grid.xy_m[:2]).T).min(axis=0) > reach_m
    assert advice.not_reached.share == np.mean(away) > 0.1
    assert f"{100 * np.mean(away):.0f} % of the plants are more than" in advice.reasons()[1]
    assert made.advice(BEGINS, AdviceSettings(0.0001, costs=CHEAP)).not_reached is None


def test_a_plot_that_is_left_says_that_few_inspections_tell_little(tmp_path):
    settings = MonitoringSettings(BEGINS)
    made = Season.create(tmp_path / "season.gpkg", a_plot(), Records.none(), settings)
    made.record(Inspections.of([9], [0], np.datetime64(BEGINS)), "day")
    asked = AdviceSettings(0.1, costs=CHEAP)
    (said,) = (one for one in made.advice(BEGINS, asked).reasons() if "By themselves" in one)
    assert said.startswith("1 plant was inspected. By themselves they do not tell: about ")
    assert "rests mostly on our default, 1 % infested where nothing is known" in said
    n, few = len(made.plot.grid), made.advice(BEGINS, asked).few
    # of a tenth infested anywhere, inspections of so many would find none with 10 %
    infested = np.ceil(0.1 * n)
    found = made.history.mean_detection(0) * np.array([few.enough, few.enough - 1]) / n
    by_chance = (1 - found) ** infested
    assert by_chance[0] <= 1 - asked.sure < by_chance[1]
    told = replace(made.settings, prior=replace(made.settings.prior, background_chance=0.011))
    made.change(told, made.settings)
    assert "mostly on what was told before" in made.advice(BEGINS, asked).few.sentence()
    half = -(-few.enough // 2)
    made.record(
        Inspections.of(np.arange(half - 1), np.zeros(half - 1), np.datetime64(BEGINS)), "more"
    )
    assert made.advice(BEGINS, asked).few.inspected == half - (half > 9)
    made.record(Inspections.of([half, half + 1], [0, 0], np.datetime64(BEGINS)), "half")
    assert made.advice(BEGINS, asked).few is None


def test_few_inspections_are_not_all_that_tells_after_finds_or_a_treatment(tmp_path):
    season = Season.create(
        tmp_path / "season.gpkg", a_plot(), Records.none(), MonitoringSettings(BEGINS)
    )
    asked = AdviceSettings(0.3, costs=CHEAP)
    season.record(Inspections.of([9], [0], np.datetime64(BEGINS)), "day")
    assert season.advice(BEGINS, asked).few is not None
    season.treat(BEGINS, 0.9, product="soap")
    assert season.advice(BEGINS, asked).few is None
    season.undo()
    season.record(Inspections.of([3], [1], np.datetime64(BEGINS)), "find")
    assert season.advice(BEGINS, asked).few is None


def test_of_few_plants_out_of_reach_nothing_is_said(season):
    advice = season.advice(BEGINS, AdviceSettings(0.9, costs=CHEAP))
    assert advice.not_reached.share == 0.0
    assert not any("from any inspection" in one for one in advice.reasons())


def test_when_nobody_can_say_it_tells_how_many_looks_decide(season):
    level = float(season.evening(BEGINS).mean())
    advice = season.advice(BEGINS, AdviceSettings(level, costs=CHEAP))
    assert advice.verdict == "inspect more"
    assert advice.more is not None
    looks = advice.more
    assert looks.if_clean is not None
    assert f"look at about {looks.if_clean} plants more; if nothing is found" in advice.headline()
    assert f"If {looks.if_found} plants more are all infested" in advice.reasons()[-1]
    one_more = replace(advice, more=replace(looks, if_found=1))
    assert one_more.reasons()[-1] == "If 1 plant more is infested, it must be treated."
    only_found = replace(advice, more=replace(looks, if_clean=None))
    assert f"look at about {looks.if_found} plants more, then" in only_found.headline()
    neither = replace(advice, more=None)
    assert "a few inspections do not decide" in neither.headline()
    assert neither.reasons() == [advice.plot.believed()]


def test_zones_become_what_the_sprayer_needs(season):
    advice = season.advice(BEGINS, AdviceSettings(0.2, costs=CHEAP, sprayer=Sprayer(1)))
    of = advice.treatment_map(season.plot.field, "soap")
    assert len(of.zones) == len(advice.zones)
    assert advice.litres == pytest.approx(advice.zones.m2 / 10_000 * 300.0)
    dear = season.advice(BEGINS, AdviceSettings(0.2, costs=TreatmentCosts(per_ha=1e7)))
    with pytest.raises(SettingError, match="pays nowhere"):
        dear.treatment_map(season.plot.field)


def test_a_rate_that_cannot_be_is_refused(season):
    with pytest.raises(SettingError, match="litres a hectare"):
        AdviceSettings(rate_l_ha=0.0)
    with pytest.raises(SettingError, match="between 0 and 1"):
        season.advice(BEGINS + timedelta(days=1), AdviceSettings(0.0))


def test_what_was_treated_that_day_is_not_proposed_anew_and_said(tmp_path):
    season = a_season(tmp_path / "s.gpkg", belief=BeliefSettings(treated=False))
    grid = season.plot.grid
    plants = np.arange(0, len(grid), 3)
    corner = (grid.xy_m[plants] - grid.xy_m.min(axis=0) < 16).all(axis=1)
    season.record(Inspections.of(plants, corner.astype(int), np.datetime64(BEGINS)), "day")
    asked = AdviceSettings(0.15, costs=replace(CHEAP, per_ha=0.01))
    before = season.advice(BEGINS, asked)
    treated = before.zones.treated & (grid.row < 3)
    assert treated.any()
    season.treat(BEGINS, 0.3, plants=treated)
    after = season.advice(BEGINS, asked)
    assert not (after.zones.treated & treated).any()
    assert after.zones.outside > 0.5
    n = np.count_nonzero(treated)
    said = f"{n} plants were treated that day and are in no zone: 30 % of the infested ones"
    assert said in " ".join(after.reasons())
    tomorrow = season.advice(BEGINS + timedelta(days=1), asked)
    assert tomorrow.done == ()
    whole = season.plot.grid.row >= 0
    season.treat(BEGINS, 0.0, plants=whole)
    again = season.advice(BEGINS, AdviceSettings(0.001, costs=CHEAP))
    assert len(again.zones) == 0
    assert again.headline().startswith("Do not treat again today: ")


@pytest.mark.parametrize(
    ("m2", "above", "verdict", "said"),
    [
        (1000.0, 1, TREAT, "Treat the whole plot, "), (995.0, 1, TREAT, "Treat the whole plot, "),
        (990.0, 1, TREAT, " in 1 zone, 99 % of the "),
        (250.0, 1, LEAVE, " of it in 1 zone, 25 % of the 0.1 ha under plants."),
        (0.0, 0, LEAVE, "Do not treat today."),
        (250.0, 0, LEAVE, "Do not treat by the threshold; by these costs alone 250 m² in 1 zone"),
        (0.0, 0, TREAT, "above the threshold, though by these costs it pays nowhere."),
    ],
)  # fmt: skip
def test_each_verdict_has_its_sentence(season, m2, above, verdict, said):
    zones = SimpleNamespace(m2=m2, plot_m2=1000.0, whole_cost=512.345, cost=500.0)
    one = SimpleNamespace(verdict=TREAT if above else LEAVE)
    of = type("Zones", (), {**vars(zones), "__len__": lambda _: int(m2 > 0)})()
    asked, plot = AdviceSettings(rate_l_ha=200.0), SimpleNamespace(verdict=verdict)
    advice = Advice(season.plot.grid, asked, plot, of, SimpleNamespace(zones=[one]))
    headline = advice.headline()
    assert said in headline
    assert advice.above == above
    assert advice.litres == pytest.approx(m2 / 50.0)
    assert (advice.saving, advice.saved) == (pytest.approx(12.345), "12.35")
    assert repr(advice) == f"<Advice: {verdict}, {counted(len(of), 'zone')}>"


@pytest.mark.parametrize(
    ("verdict", "zones", "above", "said"),
    [
        (LEAVE, [LEAVE, LEAVE], True, "The zones are below the threshold too."),
        (LEAVE, [LEAVE, INSPECT_MORE], True, "whatever the threshold says."),
        (LEAVE, [LEAVE, TREAT], True, ""), (TREAT, [LEAVE], True, ""), (LEAVE, [], True, ""),
        (INSPECT_MORE, [TREAT], True, "If you cannot inspect any more today and the costs are"),
        (TREAT, [TREAT], False, "whatever the threshold says."), (LEAVE, [], False, ""),
    ],
)  # fmt: skip
def test_zones_that_the_threshold_does_not_ask_for_are_said_to_pay_only(
    season, verdict, zones, above, said
):
    of = SimpleNamespace(zones=[SimpleNamespace(verdict=one) for one in zones])
    advice = Advice(season.plot.grid, AdviceSettings(), SimpleNamespace(verdict=verdict), zones, of)
    though = advice.though(above=above)
    assert len(though) == bool(said)
    assert said in " ".join(though)
    assert advice.is_below == ("below" in said)


def test_one_zone_that_is_the_whole_plot_is_compared_with_nothing(season):
    cheap = TreatmentCosts(per_ha=0.0, per_zone=0.1)
    advice = season.advice(BEGINS, AdviceSettings(0.01, costs=cheap))
    assert (advice.is_whole, len(advice.zones)) == (True, 1)
    said = " ".join(advice.said_of_zones())
    assert "It takes 158 l. " in said
    assert "elsewhere lose" not in said


def test_a_small_zone_is_not_nothing(season):
    zones = season.advice(BEGINS, AdviceSettings(0.01, costs=CHEAP)).zones
    small = replace(zones, m2=12.3)
    assert small.sentence().startswith("To treat 12.3 m² in ")
    advice = replace(season.advice(BEGINS, AdviceSettings(0.01, costs=CHEAP)), zones=small)
    said = " ".join(advice.said_of_zones())
    assert "0.23 % of the 0.526 ha" in said
    assert "It takes 0.37 l and" in said


def test_thousands_are_parted_in_what_zones_take_and_cost(season):
    zones = season.advice(BEGINS, AdviceSettings(0.01, costs=CHEAP)).zones
    many = replace(zones, cost=21379.5, saved=130457.0)
    assert "costs 21,379.50 and saves 130,457.00, in your currency" in many.sentence()
    asked = AdviceSettings(0.01, costs=CHEAP, rate_l_ha=50_000.0)
    said = " ".join(season.advice(BEGINS, asked).said_of_zones())
    assert re.search(r"It takes \d{1,2},\d{3} l ", said)


@pytest.mark.parametrize(
    ("saving", "said"),
    [(99.994, "99.99"), (100.0, "100"), (2000.4, "2,000"), (-3.456, "-3.46"), (-1488.0, "-1,488")],
)
def test_sums_of_a_hundred_and_more_are_said_without_hundredths(season, saving, said):
    zones = SimpleNamespace(whole_cost=saving + 5000.0, cost=5000.0)
    advice = Advice(season.plot.grid, AdviceSettings(), None, zones, None)
    assert advice.saved == said


@pytest.mark.parametrize("works", [0.9, 0.3])
def test_plants_outside_the_zones_lose_all_of_it_however_well_treating_works(season, works):
    costs = replace(CHEAP, works=works)
    advice = season.advice(BEGINS, AdviceSettings(0.01, costs=costs, rate_l_ha=50_000.0))
    lost = advice.zones.outside * costs.infested_plant_day * costs.days
    assert lost > 0.0
    assert float(advice.lost.replace(",", "")) == pytest.approx(lost, abs=0.5)
    assert f"elsewhere lose {advice.lost}." in " ".join(advice.said_of_zones())
