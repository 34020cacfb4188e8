"""A sampler in a file of one's own, as docs/own_sampler has it."""

import re

import numpy as np
import pytest

import fieldmon as fm
from fieldmon.errors import SettingError
from fieldmon.samplers import SAMPLERS, kind_of, sampler
from fieldmon.samplers.own import is_own, label_of, own_class, own_text
from fieldmon.simulation.design import Design
from tests.paths import ROOT

PAGE = (ROOT / "docs" / "own_sampler.md").read_text(encoding="utf-8")
SAMPLER, WORLD = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)


@pytest.fixture
def file(tmp_path):
    made = tmp_path / "my_sampler.py"
    made.write_text(SAMPLER, encoding="utf-8")
    return made


@pytest.fixture(scope="module")
def plot():
    return fm.read_plot("sample_data/paran_estate.zip", feature="Nursery")


def test_the_sampler_of_the_page_plans_a_day_and_beats_nobody_by_cheating(file, plot):
    day = fm.plan_day(plot, on="2026-11-18", sampler=f"{file}:Mine", robot=fm.Robot(hours=1))
    assert len(day.route) > 20
    start = fm.draw_start(plot, day.chance, 0.05)
    season = fm.simulate(
        plot,
        start,
        f"{file}:Mine",
        robot=fm.Robot(hours=1),
        settings=fm.SimulationSettings(n_days=3),
    )
    assert season.found.sum() > 0
    with fm.Monitor(plot, f"{file}:Mine", fm.Robot(hours=1)).day() as asked:
        assert asked.ask().plant == day.route.plant[0]


def test_the_world_of_the_page_runs_a_season(plot):
    world = {"fm": fm}
    exec(f"import numpy as np\n{WORLD}", world)  # noqa: S102 - the page's own lines
    start = fm.draw_start(plot, fm.plan_day(plot, on="2026-11-18").chance, 0.05)
    season = fm.simulate(plot, start, "naive", robot=fm.Robot(hours=1), settings=world["settings"])
    assert (season.new >= 0).all()
    assert (season.detection_pct <= 100.0).all()
    assert season.new[1:].sum() > 0


def on_each_way(plot, sampler):
    """Yield what hands a sampler a scene: a plan, a season, a robot's day."""
    start = fm.draw_start(plot, np.full(plot.n_plants, 0.1), 0.05)
    yield lambda: fm.plan_day(plot, on="2026-11-18", sampler=sampler)
    yield lambda: fm.simulate(plot, start, sampler)
    yield lambda: fm.Monitor(plot, sampler).day().ask()


@pytest.mark.parametrize(
    ("walk", "said"),
    [
        ("scene.chances", "AttributeError: 'Scene' object has no attribute 'chances'"),
        ("1 / 0", "ZeroDivisionError: division by zero"),
        ("raise SystemExit(3)", "SystemExit: 3"),
        *(
            (f"{array}[:] = 0", "ValueError: assignment destination is read-only")
            for array in (
                "scene.chance",
                "scene.last_inspected",
                "scene.trail",
                "would_find",
                "scene.traces.unseen",
            )
        ),
    ],
)
def test_a_mistake_in_it_is_told_with_its_line(tmp_path, plot, walk, said):
    file = tmp_path / "boom.py"
    file.write_text(
        "import fieldmon as fm\nclass Boom(fm.Sampler):\n"
        f"    def walk(self, scene, would_find):\n        {walk}\n",
        encoding="utf-8",
    )
    told = re.escape(f"Boom must run, but it ends in {said} (boom.py, line 4).")
    for way in on_each_way(plot, f"{file}:Boom"):
        with pytest.raises(SettingError, match=f"^{told}"):
            way()


@pytest.mark.parametrize("name", SAMPLERS)
def test_it_may_ask_one_of_this_package(plot, name):
    class Asks(fm.Sampler):
        inspection_times = staticmethod(sampler(name).inspection_times)
        walk = staticmethod(sampler(name).walk)

    day = fm.plan_day(plot, on="2026-11-18", sampler=Asks(), robot=fm.Robot(hours=1))
    same = fm.plan_day(plot, on="2026-11-18", sampler=sampler(name), robot=fm.Robot(hours=1))
    assert day.route.plant.tolist() == same.route.plant.tolist()


def test_a_name_in_a_file_of_settings_runs_no_code(file):
    for take in (kind_of, sampler):
        with pytest.raises(SettingError, match="must be one of naive"):
            take(f"{file}:Mine")
    with pytest.raises(SettingError, match="must be one of naive"):
        fm.Season.create(
            file.with_suffix(".gpkg"),
            fm.read_plot("sample_data/paran_estate.zip", feature="Nursery"),
            sampler=f"{file}:Mine",
        )


def test_another_text_is_another_sampler(file):
    name = f"{file}:Mine"
    first, text = own_class(name), own_text(name)
    assert own_class(name) is first
    file.write_text(f"{SAMPLER}\nMORE = 1\n", encoding="utf-8")
    assert own_text(name) != text
    assert own_class(name) is not first


def test_files_are_told_from_names():
    assert is_own("a/b.py:C")
    assert not is_own("naive")
    assert not is_own("b.py")
    assert label_of("a/b.py:C") == "C"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (None, "cannot be read"),
        ("x = 1\n", "must have a class Mine with a method walk"),
        ("class Mine: pass\n", "must have a class Mine with a method walk"),
        ("1 / 0\n", r"must run, but it ends in ZeroDivisionError: .* \(my_sampler.py, line 1\)"),
        ("def (\n", "must run, but it ends in SyntaxError"),
    ],
)
def test_a_file_without_a_sampler_is_refused_in_a_sentence(tmp_path, text, said):
    file = tmp_path / "my_sampler.py"
    if text is not None:
        file.write_text(text, encoding="utf-8")
    with pytest.raises(SettingError, match=said):
        own_class(f"{file}:Mine")


def test_two_samplers_of_a_study_have_two_names(file, tmp_path):
    other = tmp_path / "other.py"
    other.write_text(SAMPLER, encoding="utf-8")
    with pytest.raises(SettingError, match="must have different names, but they are Mine, Mine"):
        Design(samplers=(f"{file}:Mine", f"{other}:Mine"))
