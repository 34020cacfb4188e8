"""What a pest does follows from its figures."""

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.pests.pest import Entry, Increase, Movement, Pest, Stage
from fieldmon.plot.robot import Robot, Viewpoints


def test_a_rate_goes_in_straight_lines_between_its_points_and_stays_beyond_them():
    increase = Increase((10.0, 20.0, 30.0), (0.0, 0.1, 0.3))
    assert increase.at(np.array([5.0, 15.0, 25.0, 40.0])).tolist() == pytest.approx(
        [0.0, 0.05, 0.2, 0.3]
    )


def test_infestation_follows_the_increase_and_a_chance_stays_one():
    increase = Increase((10.0, 30.0), (0.1, 0.4))
    beside = Pest("a", increase=increase, movement=Movement(per_day=0.4, at_c=10.0))
    assert float(beside.infests_per_day(10.0)) == pytest.approx(0.4)
    assert float(beside.infests_per_day(30.0)) == pytest.approx(1 - 0.6**4)
    far = Pest("b", increase=increase,
               movement=Movement("cauchy", per_day=0.4, reach_m=3.0, at_c=10.0))  # fmt: skip
    assert float(far.infests_per_day(30.0)) == pytest.approx(1.6)


def test_a_pest_of_no_known_temperature_is_alike_at_all():
    pest = Pest("a", movement=Movement(per_day=0.3))
    assert pest.infests_per_day(np.array([0.0, 40.0])).tolist() == [0.3, 0.3]
    assert float(pest.infests_per_day()) == 0.3


def test_a_pest_that_says_no_rate_has_a_seasons_usual_one_and_says_so():
    usual = BeliefSettings().spread.rate_per_day
    for pest in (Pest("a"), Pest("a", movement=Movement(hours=(6.0, 20.0)))):
        assert float(pest.infests_per_day()) == usual
        assert [(one.setting, one.value) for one in pest.assumed] == [("rate_per_day", usual)]
    assert Pest("a", movement=Movement(per_day=usual)).assumed == ()


def test_a_pest_is_seen_by_its_own_viewpoints_or_chance_or_the_robots():
    assert Pest("a").seen_by(Robot()) == Robot()
    own = Pest("a", viewpoints=Viewpoints(((10.0, 0.2),), 0.3))
    assert own.seen_by(Robot(look_s=10)).detects == 0.2
    assert Pest("a", detection=0.35).seen_by(Robot()).detects == 0.35


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: Stage("egg", 80, 10), "threshold_c of egg must be -10 to 45"),
        (lambda: Stage("egg", 10, 0), "degree_days of egg must be above 0"),
        (lambda: Stage("egg", 10, 5, upper_c=9), "upper_c of egg must be above threshold_c"),
        (lambda: Increase((), ()), "one or more"),
        (lambda: Increase((90.0,), (0.1,)), "at_c of increase must be -40 to 60"),
        (lambda: Movement("cauchy", per_day=0.1), "must have a reach_m"),
        (lambda: Movement("cauchy", reach_m=3.0), "must have a per_day. Add it"),
        (lambda: Movement(per_day=1.5), "a chance in 0..1"),
        (lambda: Movement("cauchy", 0.1, reach_m=0.0), "above 0"),
        (lambda: Movement(wind="against"), "'none' or 'with'"),
        (lambda: Movement(hours=(6.0, 25.0)), "0 to 24"),
        (lambda: Movement(share_of_long_jumps=2.0), "in 0..1"),
        (lambda: Movement(along_over_across=0.0), "0.01 to 100"),
        (lambda: Movement(least_rain_mm=-1.0), "0 or more"),
        (lambda: Entry(edge_per_day=-0.1), "a chance in 0..1"),
        (lambda: Entry(depth_m=0.0), "above 0"),
        (lambda: Pest(""), "must have a name"),
        (lambda: Pest("a", cutoff="round"), "must be one of horizontal"),
        (lambda: Pest("a", mortality_per_day=2.0), "a chance in 0..1"),
        (lambda: Pest("a", latency_days=-1.0), "0 or more"),
        (lambda: Pest("a", increase=Increase((12.0, 20.0, 28.0), (0.0, 0.0, 0.2)),
                      movement=Movement(at_c=20.0)),
         "at_c of movement must be a temperature at which the pest increases, but at 20 °C"),
        (lambda: Pest("a", increase=Increase((12.0, 28.0), (1e-9, 0.2)),
                      movement=Movement("cauchy", 0.1, reach_m=3.0, at_c=12.0)),
         "per_day of movement must be 1000000 at most where the pest increases fastest"),
    ],
)  # fmt: skip
def test_figures_that_cannot_be_are_refused(make, sentence):
    with pytest.raises(SettingError) as problem:
        make()
    assert sentence in str(problem.value)
