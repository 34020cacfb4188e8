"""The samplers by name: what is said of each before it is loaded is what it does."""

import subprocess
import sys
from dataclasses import fields

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.planning.workday import plan_work
from fieldmon.plot.robot import Robot
from fieldmon.samplers import COMPARED, SAMPLERS, USUAL_SAMPLER, kind_of, of_equal_times, sampler
from fieldmon.samplers.base import Sampler
from fieldmon.samplers.registry import sampler_or_name
from tests.scenes import GRIDS, scene_on

NAMES = sorted(SAMPLERS)


@pytest.mark.parametrize("name", NAMES)
def test_what_is_said_of_a_sampler_is_what_it_does(name):
    kind, made = SAMPLERS[name], sampler(name)
    assert Sampler in type(made).__mro__
    assert made.reads_chance == kind.reads_chance
    assert (len(made.inspection_times(Robot()).stop_s) > 1) == kind.chooses_time
    own = {field.name: field.default for field in fields(made)}
    assert own.get("every") == kind.every
    assert set(kind.settings) <= set(own)


@pytest.mark.parametrize("name", NAMES)
def test_every_is_given_to_those_that_take_it(name):
    kind = kind_of(name)
    made = sampler(name, **kind.settings_for(5))
    assert getattr(made, "every", None) == (None if kind.every is None else 5)
    assert kind.settings_for(None) == {}


@pytest.mark.parametrize("name", [name for name in NAMES if SAMPLERS[name].every is not None])
def test_a_larger_every_inspects_other_plants(name):
    scene = scene_on(GRIDS["rectangle"], hours=2.0)
    own, other = (plan_work(scene, sampler(name, every=n)).plant for n in (SAMPLERS[name].every, 5))
    assert not np.array_equal(own, other)


def test_titles_are_short_and_differ():
    titles = [kind.title for kind in SAMPLERS.values()]
    assert len(set(titles)) == len(titles)
    assert max(map(len, titles)) < 20
    assert all(":" not in kind.title + kind.does for kind in SAMPLERS.values())


def test_the_usual_one_is_offered_first_then_those_that_read_chances():
    offered = of_equal_times()
    assert next(iter(offered)) == USUAL_SAMPLER
    reads = [kind.reads_chance for kind in offered.values()]
    assert reads == sorted(reads, reverse=True)
    assert set(offered) == {name for name in NAMES if not SAMPLERS[name].chooses_time}
    assert set(COMPARED) <= set(offered)


def test_an_unknown_sampler_is_refused_with_the_known_ones():
    for ask in (sampler, kind_of):
        with pytest.raises(SettingError, match=r"one of .*dynamic.* but it is 'best'"):
            ask("best")


def test_a_class_of_ones_own_that_nobody_made_is_refused_with_what_to_write():
    class Mine(Sampler):
        def walk(self, scene, would_find):
            """Inspect nothing."""

    with pytest.raises(SettingError, match=r"it is the class Mine itself\. Give Mine\(\)\."):
        sampler_or_name(Mine)
    with pytest.raises(SettingError, match="but it is the class int"):
        sampler_or_name(int)


def test_names_are_known_without_loading_anything():
    code = "import sys, fieldmon.samplers; print('numpy' in sys.modules, 'numba' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "False"]
