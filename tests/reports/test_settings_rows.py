"""What a day goes by, each value with where it comes from."""

from dataclasses import replace

import pytest

from fieldmon.infestation.prior import PriorSettings
from fieldmon.infestation.spread import Spread
from fieldmon.monitoring import KeptMessage, MonitoringSettings
from fieldmon.monitoring.history import BeliefSettings
from fieldmon.plot.robot import Robot, scout
from fieldmon.reports.content import Listing, Table
from fieldmon.reports.settings_rows import WorkSettings, settings_blocks
from tests.monitoring.seasons import BEGINS

USUAL = WorkSettings(Robot(), "adaptive", PriorSettings(), BeliefSettings())


def rows(settings):
    (table,) = [block for block in settings_blocks(settings) if isinstance(block, Table)]
    return {name: (value, origin) for name, value, origin in table.rows}


@pytest.mark.parametrize("robot", [Robot(), scout()])
def test_what_nobody_chose_is_marked_as_assumed(robot):
    made = rows(replace(USUAL, robot=robot))
    assert all(origin.startswith("assumed") for _, origin in made.values())
    assert made["Seconds at a plant"][0] == f"{robot.look_s:g}"


@pytest.mark.parametrize(
    ("changed", "name", "value"),
    [
        ({"robot": Robot(hours=3)}, "Working hours", "3"),
        ({"robot": Robot(speed_m_s=1.0)}, "Speed", "3.6 km/h"),
        ({"robot": Robot(detection=0.7)}, "Finds what is there", "70%"),
        ({"sampler": "naive"}, "Who chooses the plants", "Naive"),
        ({"prior": PriorSettings(background_chance=0.03)}, "Chance where nothing is known", "3 %"),
        (
            {"belief": BeliefSettings(Spread(rate_per_day=0.1, arrivals_per_day=0.0002))},
            "Spread to a neighbour, a night",
            "10 %",
        ),
        (
            {"belief": BeliefSettings(Spread(rate_per_day=0.02, arrivals_per_day=0.0))},
            "Plants new from outside, a night",
            "none",
        ),
        ({"belief": BeliefSettings(treated=False)}, "Plants found are", "flagged"),
    ],
)
def test_what_was_chosen_is_said_to_be(changed, name, value):
    made = rows(replace(USUAL, **changed))
    assert made[name] == (value, "chosen")
    assert [one for one, (_, origin) in made.items() if origin == "chosen"] == [name]


def test_without_a_season_nothing_is_said_of_nights():
    made = rows(replace(USUAL, belief=None))
    assert "Plants found are" not in made
    assert "Working hours" in made


def test_of_an_import_s_messages_the_guesses_are_kept_three_at_most():
    messages = [KeptMessage("plot.zip", severity, None, f"{severity} {k}")
                for severity in ("seen", "guessed") for k in range(5)]  # fmt: skip
    made = WorkSettings.of_season(MonitoringSettings(BEGINS), messages)
    assert made.guessed == tuple(f"guessed {k}" for k in range(5))
    (listing,) = [one for one in settings_blocks(made) if isinstance(one, Listing)]
    assert listing.sentences == made.guessed[:3]
