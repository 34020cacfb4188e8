"""Samplers are named on the command line; one of a person's own works on a plot."""

from types import SimpleNamespace

import pytest

from fieldmon.cli.sampler_names import known, known_or_own
from fieldmon.errors import SettingError
from fieldmon.samplers import SAMPLERS
from tests.cli.estate import BEGINS, ZIP
from tests.docs.pages import PAGES, fences

PLOT = (ZIP, "--feature", "Nursery", "--hours", 0.5)
MINE = "my_sampler.py:Mine"


@pytest.fixture
def mine(tmp_path):
    """Write the sampler of the page."""
    text = next(iter(fences(PAGES["docs/own_sampler.md"], "python")))
    (tmp_path / "my_sampler.py").write_text(text, encoding="utf-8")


def test_every_sampler_of_the_program_is_known_and_no_other():
    option = SimpleNamespace(opts=["--sampler"])
    every = list(SAMPLERS)
    assert known(option, every) == known_or_own(option, every) == every
    assert known_or_own(option, MINE) == MINE
    assert known(option, None) is None
    for refused, name in ((known, "best"), (known_or_own, "best"), (known, MINE)):
        with pytest.raises(
            SettingError, match=f"^--sampler must be one of naive, .*but it is '{name}'"
        ):
            refused(option, name)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["plan", *PLOT, "--date", BEGINS, "-o", "day.geojson"], "Planned by Mine."),
        (["simulate", *PLOT, "--date", BEGINS, "--days", 2, "-o", "days.csv"], "\nMine\n"),
    ],
)
@pytest.mark.usefixtures("mine")
def test_one_of_ones_own_works_on_a_plot_under_its_name(run, words, says):
    code, out, err, made = run(*words, "--sampler", MINE)
    assert code == 0, err
    assert says in out
    (file,) = [path for path in made if path.suffix in {".geojson", ".csv"}]
    assert "Mine" in file.read_text("utf-8")
    assert "my_sampler" not in file.read_text("utf-8")


@pytest.mark.parametrize("command", ["init", "drive", "compare"])
@pytest.mark.usefixtures("mine")
def test_elsewhere_it_is_said_where_it_works(run, command):
    words = ["season.gpkg", *PLOT] if command == "init" else PLOT
    code, _, err, made = run(command, *words, "--sampler", MINE)
    assert (code, made) == (2, set())
    assert err.splitlines()[-1].endswith(
        f"but it is {MINE!r}. One of your own works in fieldmon plan and simulate, on a plot, and "
        "in fieldmon study run and samplers."
    )
