"""What the pages show runs, and prints what they say."""

import re
import shlex
import shutil
import sys
import warnings

import pytest

import fieldmon
from fieldmon.cli.main import main
from tests.docs.pages import PAGES, README, fences, the_fence
from tests.paths import SAMPLE_DATA

TUTORIAL = PAGES["docs/tutorial.md"]
NUMBERS = ("no", "one", "two", "three", "four")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Stand in a folder with the sample data and nothing else."""
    shutil.copytree(SAMPLE_DATA, tmp_path / "sample_data")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def run(monkeypatch):
    """Run a command in this process; it must end well."""

    def run(words):
        assert words[0] == "fieldmon"
        monkeypatch.setattr(sys, "argv", words)
        with pytest.raises(SystemExit) as stop:
            main()
        assert stop.value.code == 0

    return run


def words_of(block):
    """Return the words of each line of a block, comments left out."""
    return [shlex.split(line, comments=True) for line in block.replace("\\\n", " ").splitlines()]


def test_the_commands_of_the_readme_run(folder, run, capsys):
    lines = words_of(the_fence(README, "sh", "fieldmon plots"))
    assert len(lines) == 5
    for words in lines:
        run(words)
    assert {"route.geojson", "season.gpkg", "day.csv", "day.gpx"} <= {
        path.name for path in folder.iterdir()
    }
    # nobody has filled anything in
    assert "day.csv: 0 new" in capsys.readouterr().out


def test_the_python_lines_of_the_readme_run(folder):
    (block,) = fences(README, "python")
    assert len([line for line in block.splitlines() if line]) == 6
    known = {}
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        exec(compile(block, "README.md", "exec"), known)  # noqa: S102 - our own lines
    assert {one.category for one in said} == {fieldmon.ImportDoubt}
    assert any("669 of 998 records lie outside Gate" in str(one.message) for one in said)
    assert (folder / "day.gpx").stat().st_size > 10_000
    assert len(known["day"].route) > 100


#: pages whose lines stand by themselves
OTHERS = [name for name in PAGES if name != "README.md" and fences(PAGES[name], "python")]


@pytest.mark.usefixtures("folder")
def test_the_python_lines_of_all_other_pages_run():
    """One interpreter for all; notebooks are executed with the pages."""
    assert len(OTHERS) >= 3
    for name in OTHERS:
        known = {}
        for block in fences(PAGES[name], "python"):
            exec(compile(block, name, "exec"), known)  # noqa: S102 - our own lines


def test_the_tutorial_prints_the_plan_that_it_says(folder, run, capsys):
    (words,) = words_of(the_fence(TUTORIAL, "sh", "--paths"))
    (told,) = fences(TUTORIAL, "text")
    run(words)
    said = capsys.readouterr()
    messages, gate, plan = told.partition("Gate: ")
    assert said.out == gate + plan
    # the first plan of a machine says besides that it is being compiled
    assert set(messages.splitlines()) <= set(said.err.splitlines())
    assert (folder / "route.geojson").exists()


def test_the_season_of_the_tutorial_comes_out_as_it_says(folder, run, capsys, monkeypatch):
    monkeypatch.syspath_prepend(str(folder / "sample_data"))
    from pretend import main as work

    (begin,) = words_of(the_fence(TUTORIAL, "sh", "fieldmon init"))
    run(begin)
    days = the_fence(TUTORIAL, "sh", "for day in")
    plan, pretend, record = [words for words in words_of(days) if words][1:4]
    (status,) = [words for words in words_of(days) if words[1:2] == ["status"]]
    for day in re.search(r"for day in ([\d ]+);", days)[1].split():
        run([word.replace("$day", day) for word in plan])
        work(folder / pretend[-1])
        run(record)
    capsys.readouterr()
    run(status)
    said = capsys.readouterr().out
    inspected, plants, found = re.search(
        r"so far +([\d,]+) of ([\d,]+) plants .* ([\d,]+) found", said
    ).groups()
    expected, low, high = re.search(
        r"still infested +([\d.,]+) \(([\d,]+) to ([\d,]+)", said
    ).groups()
    spots = NUMBERS[int(re.search(r"hot spots +(\d)", said)[1])]
    told = " ".join(TUTORIAL.split())
    assert f"{inspected} of {plants} plants are inspected and {found} were found infested" in told
    assert f"There are {spots} hot spots." in told
    assert f"{float(expected):.0f} infested plants are expected still out there" in told
    assert f"({low} to {high})" in told


def test_the_simulation_of_the_tutorial_comes_out_as_it_says(folder, run, capsys):
    (words,) = words_of(the_fence(TUTORIAL, "sh", "fieldmon simulate"))
    run(words)
    last = re.findall(r"^ +10 +([\d.]+) ", capsys.readouterr().out, re.MULTILINE)
    adaptive, dynamic, naive, bouncy = last
    told = " ".join(TUTORIAL.split())
    assert f"has found {adaptive} % of all infestations so far, Dynamic {dynamic} %" in told
    assert f"Naive {naive} % and Bouncy {bouncy} %" in told
    assert (folder / "season.csv").exists()
