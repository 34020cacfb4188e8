"""What somebody's own sampler answers is checked; that of this package is not."""

import numpy as np
import pytest
from shapely import MultiPolygon, box

import fieldmon as fm
from fieldmon.errors import SettingError
from fieldmon.planning.workday import plan_work, work_day
from fieldmon.plot.field import Field
from fieldmon.samplers import sampler
from fieldmon.samplers.base import InspectionTimes, Stops
from fieldmon.samplers.checked_sampler import Checked, must_detect
from tests.scenes import GRIDS, scene_on


class Told(fm.Sampler):
    """Answers what it was told to."""

    def __init__(self, answer):
        self.answer = answer

    def walk(self, scene, would_find):
        return self.answer(scene, would_find) if callable(self.answer) else self.answer


def Answers(answer):  # noqa: N802 - as the sentences name it
    return Checked(Told(answer))


def scene():
    return scene_on(GRIDS["rectangle"], hours=2.0, seed=1)


def honest(scene, *plants, late_s=0.0):
    """Return stops at plants, as fast as a robot can."""
    at, now, arrive = scene.at, 0.0, []
    for plant in plants:
        now += scene.travel_s(at, plant) + late_s
        arrive.append(now)
        at, now = plant, now + scene.robot.visit_s
    return Stops(np.array(plants, np.int32), np.array(arrive))


def test_what_a_robot_can_do_is_taken_as_it_is():
    own = Answers(lambda scene, _: honest(scene, 5, 3, 40))
    work = plan_work(scene(), own)
    assert work.plant.tolist() == [5, 3, 40]
    waits = Answers(lambda scene, _: honest(scene, 5, 3, late_s=60.0))
    assert len(plan_work(scene(), waits)) == 2


@pytest.mark.parametrize("returns", [True, False])
def test_who_names_no_plant_is_named_where_hours_reach_one(returns):
    plot = fm.Plot.of(Field("square", GRIDS["rectangle"].frame.geometry_lonlat(
        MultiPolygon([box(-30, -30, 30, 30)]))))  # fmt: skip
    nobody = Told(Stops(np.empty(0, np.int32), np.empty(0)))
    start = fm.draw_start(plot, np.full(plot.n_plants, 0.1))
    short = fm.SimulationSettings(n_days=2)
    day, soon = fm.Robot(hours=2.0, returns=returns), fm.Robot(hours=0.001, returns=returns)
    for asked in (
        lambda robot: fm.plan_day(plot, on="2026-11-18", robot=robot, sampler=nobody),
        lambda robot: fm.simulate(plot, start, nobody, robot=robot, settings=short),
        lambda robot: list(fm.simulate_days(plot, start, nobody, robot=robot)),
    ):
        with pytest.raises(SettingError, match=r"^Told must name plants .*, though 2 h reach some"):
            asked(day)
    with pytest.raises(SettingError, match="The working day must be long enough"):
        fm.plan_day(plot, on="2026-11-18", robot=soon, sampler=nobody)
    assert fm.simulate(plot, start, nobody, robot=soon, settings=short).visits == 2


def test_lists_and_other_whole_numbers_will_do():
    there = honest(scene(), 5, 3)
    answered = Answers((there.plant.tolist(), there.arrive_s.tolist())).walk(
        scene(), np.zeros(200, bool)
    )
    assert answered.plant.dtype == np.int32
    assert answered.plant.tolist() == [5, 3]


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (None, "it answers None"),
        ([1, 2, 3], "it answers a list"),
        (Stops(np.array([1.0]), np.array([90.0])), r"float64 \(1,\), float64"),
        (Stops(np.array([1, 2]), np.array([90.0])), r"int64 \(2,\), float64 \(1,\)"),
        (Stops(np.array([-1, 2]), np.array([0.0, 90.0])), "plants from 0 on, but -1"),
        (Stops(np.array([10**6]), np.array([900.0])), "0 to [0-9]+, but 1000000"),
        (Stops(np.array([4, 4]), np.array([900.0, 1900.0])), "twice a day, but plant 4"),
        (Stops(np.array([4]), np.array([np.nan])), "when a robot can be there, but it says nan"),
        (Stops(np.array([4]), np.array([np.inf])), "but it says inf"),
        (Stops(np.array([4]), np.array([0.0])), "but it says 0.0 s"),
        (Stops(np.array([4, 9]), np.array([900.0, 901.0])), "at plant 9 when"),
        (Stops(np.array([4]), np.array([7199.0])), "end the day within 7200 s"),
        (
            Stops(np.array([4]), np.array([900.0]), np.array([1], np.uint8)),
            "its 1 inspection times, but it chooses number 1",
        ),
    ],
)
def test_what_no_robot_can_do_is_refused(answer, said):
    with pytest.raises(SettingError, match=f"^Told must .*{said}"):
        plan_work(scene(), Answers(answer))


def test_a_plant_inspected_today_is_refused():
    seen = scene()
    seen.last_inspected[7] = seen.day
    with pytest.raises(SettingError, match="plant 7 is answered"):
        plan_work(seen, Answers(lambda scene, _: honest(scene, 7)))


@pytest.mark.parametrize(
    ("times", "said"),
    [
        (InspectionTimes(np.array([0.0]), np.array([0.5])), "more than 0 s"),
        (InspectionTimes(np.array([40.0]), np.array([1.5])), "chances from 0 to 1"),
    ],
)
def test_inspections_that_cannot_be_are_refused(times, said):
    class Odd(Told):
        def inspection_times(self, robot):  # noqa: ARG002
            return times

    with pytest.raises(SettingError, match=said):
        plan_work(scene(), Checked(Odd(lambda scene, _: honest(scene, 7))))


def test_who_knows_what_it_has_not_seen_is_refused():
    peeks = Answers(lambda scene, would_find: honest(scene, *np.flatnonzero(would_find)))
    would_find = np.zeros(len(scene().chance), bool)
    would_find[[3, 9]] = True
    with pytest.raises(SettingError, match="Read would_find only of plants that were reached"):
        work_day(scene(), peeks, would_find)

    def after_its_first(scene, would_find):
        later = np.array([4, 5, 6, 7, 8, 9])
        first = would_find[3] > 0
        return honest(scene, 2, 3, *later[np.argsort(~would_find[later] if first else later)])

    with pytest.raises(SettingError, match="by what was found at those before it"):
        work_day(scene(), Answers(after_its_first), would_find)

    def avoids(scene, would_find):  # what it leaves out tells of plants that it has not seen
        return honest(scene, 2, 3, *([4] if would_find[9] else [5]))

    with pytest.raises(SettingError, match="by what was found at those before it"):
        work_day(scene(), Answers(avoids), would_find)

    def follows(scene, would_find):
        return honest(scene, 2, 3, *((4,) if would_find[3] else (9,)))

    assert work_day(scene(), Answers(follows), would_find).plant.tolist() == [2, 3, 4]


def test_what_is_kept_in_mind_is_what_its_own_plants_showed():
    class Keeps(Told):
        def walk(self, scene, would_find):
            self.kept = np.array(would_find)
            return super().walk(scene, would_find)

    would_find = np.zeros(len(scene().chance), bool)
    would_find[[3, 5, 9]] = True
    for plants, found in (((2, 4), []), ((2, 3), [3]), ((2, 3, 4, 5), [3, 5])):
        own = Keeps(lambda scene, _, plants=plants: honest(scene, *plants))
        assert work_day(scene(), Checked(own), would_find).plant.tolist() == [*plants]
        assert np.flatnonzero(own.kept).tolist() == found


def test_who_finds_nothing_on_its_way_is_asked_once_and_told_nothing():
    asked = []

    def walk(scene, would_find):
        asked.append(would_find.any())
        return honest(scene, 2, 4)

    work_day(scene(), Answers(walk), np.arange(len(scene().chance)) == 3)
    assert asked == [False]


def test_a_season_and_a_robot_get_the_same_sentence():
    plot = fm.read_plot("sample_data/paran_estate.zip", feature="Nursery")
    own = Told(Stops(np.array([-1]), np.array([0.0])))
    start = fm.draw_start(plot, fm.plan_day(plot, on="2026-11-18").chance, 0.1)
    with pytest.raises(SettingError, match="plants from 0 on"):
        fm.simulate(plot, start, own)
    assert repr(fm.Monitor(plot, own)) == "<Monitor Nursery: Told, day 1>"
    with fm.Monitor(plot, own).day() as day, pytest.raises(SettingError, match="plants from 0 on"):
        day.ask()


def test_a_look_that_finds_nothing_is_refused_and_no_longer_hours_asked_for():
    plot = fm.read_plot("sample_data/paran_estate.zip", feature="Nursery")
    with pytest.raises(SettingError, match=r"19\.9 s at a plant find 0 %: those of less than 20 s"):
        fm.plan_day(plot, on="2026-11-18", robot=fm.Robot(look_s=19.9))
    with pytest.raises(SettingError, match="its chance is 0 %"):
        must_detect(sampler("naive"), fm.Robot(detection=0.0))
    must_detect(sampler("adaptive", chooses_time=True), fm.Robot(look_s=10.0))
