"""What a day goes by, each value with where it comes from."""

from dataclasses import replace
from datetime import date

import numpy as np
import pytest

from fieldmon.compute.units import Units
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.monitoring.estimates.last_days import last_date
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.pests.pest import Pest
from fieldmon.pests.weather import DAY_S, weather_of
from fieldmon.plot.assumed import Assumed
from fieldmon.plot.robot import Robot
from fieldmon.reports.content import Listing, Table
from fieldmon.reports.settings_rows import WorkSettings, assumed_sentence, settings_blocks
from tests.reports.reading import plain

TOLD = WorkSettings(Robot(), "adaptive", PriorSettings(), (4.0, 2.5), (), BeliefSettings())
ALL = tuple(
    Assumed(name, 0.5)
    for name in ("row_spacing_m", "plant_spacing_m", "speed_m_s", "detects", "background_chance",
                 "rate_per_day", "treated")
)  # fmt: skip


def rows(settings, units=None):
    (table,) = [
        block for block in settings_blocks(settings, units or Units()) if isinstance(block, Table)
    ]
    return {name: (value, origin) for name, value, origin in table.rows}


def test_what_is_assumed_is_marked_and_nothing_else():
    marked = {
        "From row to row", "From plant to plant", "Speed", "Finds what is there",
        "Chance where nothing is known", "Spread to a neighbour, a night",
        "Plants found are",
    }  # fmt: skip
    made = rows(replace(TOLD, assumed=ALL))
    assert {name for name, (_, origin) in made.items() if origin == "assumed"} == marked
    assert "assumed" not in {origin for _, origin in rows(TOLD).values()}


def test_the_sentence_names_what_is_assumed_with_its_value():
    said = assumed_sentence(replace(TOLD, assumed=ALL[:3]), Units())
    assert said == (
        "Assumed, though nobody said so: From row to row: 4.0 m; From plant to plant: 2.5 m; "
        "Speed: 2.5 km/h."
    )
    assert assumed_sentence(TOLD, Units()) == ""


@pytest.mark.parametrize(
    ("changed", "name", "shown"),
    [
        ({"robot": Robot(hours=3)}, "Working hours", ("3", "chosen")),
        ({}, "Working hours", ("12", "the usual")),
        ({"robot": Robot(speed_m_s=1.0)}, "Speed", ("3.6 km/h", "chosen")),
        ({"robot": Robot(detection=0.7)}, "Finds what is there", ("70 %", "chosen")),
        ({"sampler": "naive"}, "Who chooses the plants", ("Naive", "chosen")),
        (
            {"belief": BeliefSettings(Spread(rate_per_day=0.1, arrivals_per_day=0.0))},
            "Plants new from outside, a night",
            ("none", "chosen"),
        ),
        ({"belief": BeliefSettings(treated=False)}, "Plants found are", ("only flagged", "chosen")),
        ({}, "From row to row", ("4.0 m", "of the plot's file")),
        ({"chosen": ("row_spacing_m",)}, "From row to row", ("4.0 m", "chosen")),
        ({"assumed": ALL[:1]}, "From row to row", ("4.0 m", "assumed")),
        (
            {"assumed": (Assumed("row_bearing_deg", 72.31),)},
            "Rows run along the longest side",
            ("72.3° from north", "assumed"),
        ),
    ],
)
def test_each_value_is_said_with_where_it_comes_from(changed, name, shown):
    assert rows(replace(TOLD, **changed))[name] == shown


def test_lengths_are_in_the_units_chosen():
    assert rows(TOLD, Units("ft"))["From row to row"][0] == "13.1 ft"


def test_without_a_season_nothing_is_said_of_nights():
    made = rows(replace(TOLD, belief=None))
    assert "Plants found are" not in made
    assert "Working hours" in made


def test_a_season_s_own_are_taken(worked):
    made = WorkSettings.of_season(worked, last_date(worked))
    assert made.assumed == worked.assumed()
    assert made.chosen == worked.plot.chosen
    assert made.robot == worked.settings.robot
    assert made.spacing_m == (worked.plot.grid.row_spacing_m, worked.plot.grid.plant_spacing_m)


def test_what_the_season_learnt_is_of_who_inspects(worked, last):
    """As `fieldmon plan` says it, not of the average of all who inspected so far."""
    made = WorkSettings.of_season(worked, last)
    for detects in (0.5, 0.9):
        own = replace(made, robot=replace(made.robot, detection=detects))
        (learnt,) = (one for one in worked.learnt(last, detects) if one.name == "detection")
        assert own.with_learnt(worked, last).learnt_detection == learnt.value


def test_a_detection_that_the_season_learnt_stands_beside_the_one_told_where_they_differ():
    told, name = rows(replace(TOLD, learnt_detection=0.841)), "The same, as the season learnt"
    assert name not in told
    learnt = rows(replace(TOLD, learnt_detection=0.96))
    assert learnt[name] == ("96 %", "for chances, not for routes")
    assert learnt["Finds what is there"] == told["Finds what is there"]


def test_of_what_was_guessed_three_sentences_are_shown():
    guessed = tuple(f"Guess {k}." for k in range(5))
    blocks = settings_blocks(replace(TOLD, guessed=guessed), Units())
    (listing,) = [one for one in blocks if isinstance(one, Listing)]
    assert listing.sentences == guessed[:3]


def test_a_named_pest_and_its_weather_stand_in_the_place_of_the_usual_nights():
    at = np.datetime64("2026-11-01", "s") + 86_400 * np.arange(9)
    weather = weather_of(at, DAY_S, temperature_c=np.full(9, 20.0))
    mite = shipped_pest("spider-mite")
    told = replace(TOLD, pest_in_weather=PestInWeather(mite, weather, date(2026, 6, 1)))
    with_weather = rows(told)
    (below,) = [one for one in settings_blocks(told, Units()) if isinstance(one, Listing)]
    (said,) = [plain(one) for one in below.sentences]
    assert said == "Pest, by which nights go: Two-spotted spider mite, by degree-days (chosen)"
    assert "Pest, by which nights go" not in with_weather, "a column has no room for it"
    assert with_weather["Its weather"] == ("2026-11-01 to 2026-11-09", "of the weather file")
    assert "Spread to a neighbour, a night" not in with_weather
    without = rows(replace(TOLD, pest_in_weather=PestInWeather(mite)))
    assert without["Its weather"][0] == "none: as its figures hold"
    unsaid = rows(replace(TOLD, pest_in_weather=PestInWeather(Pest("own"))))
    assert unsaid["Spread to a neighbour, a night"] == ("2 %", "assumed")
