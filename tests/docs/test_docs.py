"""What the pages name is there."""

import ast
import builtins
import re
import shlex
import tomllib
from functools import cache

import pytest
import typer
import yaml

import fieldmon
from fieldmon.cli.main import app
from fieldmon.io.packaged import pest_names
from fieldmon.io.writers.handoff import FORMATS
from fieldmon.samplers import SAMPLERS
from tests.docs.pages import DOCS, INLINE, PAGES, README, fences, prose
from tests.paths import ROOT
from tests.test_floors import FLOORS, SEASON_FLOORS

LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
OWN_FILE = re.compile(
    r"(?:(?:fieldmon|app|tests|docs|sample_data|\.ci)/[\w./-]*|CITATION\.cff|Containerfile)"
)
# stands where a page leaves room for a name
ROOM = re.compile(r"[A-Z]{3,}\.(?:py|toml)")
# an app's header, a file at the root
NO_CLASSES = {"Upgrade", "Connection", "Containerfile"}
GONE = re.compile(
    r"\b(?:geodata|cli_\w+|monitor\.py|first_use|fieldmon\.thesis|fieldmon\.project|with_prior|"
    r"read_findings|Slips|Outlook|Company|MeanField)\b"
)
#: what a season can be asked, and holds: a new one takes the place of another
MOST_OF_A_SEASON = 69


def anchors(text):
    """Return the anchors of a page's headings, as GitHub and MyST make them."""
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def whole(page):
    """Return the text of a page, or of the one that it includes."""
    text = page.read_text(encoding="utf-8")
    included = re.fullmatch(r"```\{include\} (\S+)\n(?::.*\n)*```\n?", text)
    return whole(page.parent / included[1]) if included else text


def command_lines(text):
    """Yield the words of every `fieldmon` command of a page, and whether it is a whole one."""
    for block in fences(text, "sh"):
        for line in block.replace("\\\n", " ").splitlines():
            words = shlex.split(line, comments=True)
            if words[:1] == ["fieldmon"]:
                yield (*words[1:],), True
    for said in INLINE.findall(prose(text)):
        if said.startswith("fieldmon "):
            yield (*shlex.split(said)[1:],), False


COMMANDS = sorted({(name, *line) for name, text in PAGES.items() for line in command_lines(text)})


@pytest.mark.parametrize("name", PAGES)
def test_every_link_leads_to_a_page_and_a_heading(name):
    for target in LINK.findall(prose(PAGES[name])):
        if target.startswith("https://"):
            continue
        path, _, heading = target.partition("#")
        page = (ROOT / name).parent / path if path else ROOT / name
        assert page.exists(), target
        if heading:
            assert heading in anchors(whole(page)), target


@pytest.mark.parametrize("name", PAGES)
def test_every_file_that_a_page_names_is_there(name):
    said = [*INLINE.findall(PAGES[name]), *fences(PAGES[name], "sh")]
    for path in {path for words in said for path in OWN_FILE.findall(words)}:
        if "_build" not in path and not ROOM.search(path):
            assert (ROOT / path).exists(), path


@cache
def defined():
    """Return the names of all classes and functions of the library."""
    code = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "fieldmon").rglob("*.py"))
    return set(re.findall(r"^(?:class|def) (\w+)", code, re.MULTILINE))


@cache
def whole_command():
    """Return the command with all that is below it."""
    return typer.main.get_command(app)


@pytest.mark.parametrize("name", PAGES)
def test_every_module_and_class_that_a_page_names_is_there(name):
    for said in INLINE.findall(prose(PAGES[name])):
        for dotted in re.findall(r"\b(?:fm|fieldmon)\.([a-zA-Z_][\w.]*)", said):
            module = ROOT / "fieldmon" / dotted.replace(".", "/")
            there = module.is_dir() or module.with_suffix(".py").exists()
            assert there or hasattr(fieldmon, dotted.split(".")[0]), said
        # a class stands alone in its backquotes: `Robot`, `RoadNetwork`
        if re.fullmatch(r"(?:[A-Z][a-z]+)+", said) and said not in NO_CLASSES:
            assert said in defined(), said


@pytest.mark.parametrize(("name", "words", "whole"), COMMANDS)
def test_every_command_line_is_one_that_fieldmon_takes(name, words, whole):
    command, left = whole_command(), [word.replace("$day", "18") for word in words]
    while hasattr(command, "commands") and left and not left[0].startswith("-"):
        assert left[0] in command.commands, name
        command = command.commands[left.pop(0)]
    if whole:
        # taken as it would be, values and all; nothing is run
        command.make_context("fieldmon", left)
    else:
        # in a sentence a command may leave out what it needs, but not name what there is not
        command.make_parser(command.context_class(command)).parse_args(left)


def test_every_command_is_on_a_page():
    said = " ".join(PAGES.values())

    def names(command, name):
        for own, inner in getattr(command, "commands", {}).items():
            yield from names(inner, f"{name} {own}")
        if not hasattr(command, "commands"):
            yield name

    missing = [name for name in names(whole_command(), "fieldmon") if name not in said]
    assert missing == []


def test_every_name_of_the_library_is_on_its_page():
    page = PAGES["docs/api.md"]
    told = set(re.findall(r"^ {3}(\w+)$", page, re.MULTILINE)) | set(INLINE.findall(page))
    assert set(fieldmon.__all__) - {"__version__"} <= told


def test_what_a_season_can_be_asked_is_there_each_once():
    table = PAGES["docs/api.md"].partition("| of a season |")[2].partition("\n\n")[0]
    named = re.findall(r"`(\w+)`", table)
    # what is set as one is opened: its class does not have it
    held = {"drafts", "plot", "records", "risk", "store"}
    asked = {name for name in dir(fieldmon.Season) if not name.startswith("_")} | held
    # what only commands and pages need is a function of its room
    assert sorted(named) == sorted(asked)
    assert len(asked) <= MOST_OF_A_SEASON


def test_every_pest_that_comes_along_has_its_line():
    table = PAGES["docs/pests.md"].partition("\n## Included pests\n")[2].partition("\n## ")[0]
    assert sorted(re.findall(r"^\| `([\w-]+)` \|", table, re.MULTILINE)) == sorted(pest_names())


def test_every_sampler_and_every_route_format_has_its_line():
    assert SAMPLERS.keys() <= set(INLINE.findall(PAGES["docs/strategies.md"]))
    told = set(INLINE.findall(PAGES["docs/routes.md"]))
    for chosen in FORMATS.values():
        assert told & set(chosen.endings), chosen.reader


@pytest.mark.parametrize("name", PAGES)
def test_no_page_names_what_is_gone(name):
    assert GONE.findall(PAGES[name]) == []


def test_the_readme_is_short_and_says_how_to_test():
    assert len(README.split()) < 900
    # before the first command that needs it
    assert README.find("`. .venv/bin/activate`") in range(1, README.index("\nfieldmon "))
    command = README.partition("<!-- test command -->\n```sh\n")[2].partition("\n```\n")[0]
    assert len(command.splitlines()) == 1
    for part in (
        "ruff check .",
        "ruff format --check .",
        "mypy",
        "pytest -n auto",
    ):
        assert f".venv/bin/{part}" in command
    # notebooks are run and pages made by a second command
    assert "sphinx-build -E -W" in PAGES["CONTRIBUTING.md"]


def test_the_glossary_says_the_terms_that_matter():
    terms = re.findall(r"^(\w[\w -]*)\n  \S", PAGES["docs/glossary.md"], re.MULTILINE)
    assert len(terms) == len(set(terms)) >= 30
    assert {
        *("chance", "belief", "prior", "kernel", "detection rate", "adjacency", "headland"),
        *("aisle", "lane", "traversal", "orienteering", "prize", "inspection", "find"),
        *("treatment", "hot spot", "plant", "row", "block", "xy_m", "lonlat", "bound", "strategy"),
    } <= set(terms)


def test_the_picture_of_the_rooms_shows_the_floors_as_they_are_held():
    page = PAGES["docs/architecture.md"].partition("\n## Where each change goes")[0]
    drawn = [set(re.findall(r"<b>(\w+)</b>", line)) for line in page.splitlines() if "<b>" in line]
    floors = [{"fieldmon" if room == "__init__" else room for room in floor} for floor in FLOORS]
    assert drawn == floors[::-1]
    told = re.findall(r"^\| `(?:fieldmon/)?(\w+)(?:\.py)?` \|", page, re.MULTILINE)
    assert set(told) == {room for floor in FLOORS for room in floor}


def test_the_rooms_of_a_season_are_told_from_the_lowest_floor_up():
    told = re.findall(r"^\| `monitoring/(\w+)` \|", PAGES["docs/architecture.md"], re.MULTILINE)
    assert told == SEASON_FLOORS


def test_a_stranger_is_told_the_one_room_for_each_change():
    page = PAGES["docs/architecture.md"].partition("## Where each change goes")[2]
    tour = page.partition("\n## ")[0]
    rows = [line.split(" | ") for line in tour.splitlines() if line.startswith("| ")][1:]
    assert rows
    for _, room, _where in rows:
        assert (ROOT / room.strip("`")).is_dir(), room


def test_the_steps_of_a_change_stand_in_one_place():
    steps = PAGES["CONTRIBUTING.md"]
    told = re.findall(r"^## (Add an? .+)$", steps, re.MULTILINE)
    linked = re.findall(r"\| \[([^\]]+)\]\(contributing\.md#", PAGES["docs/architecture.md"])
    assert set(linked) == set(told) != set()


def test_the_citation_has_what_its_format_asks_for():
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert {"cff-version", "message", "title", "authors", "version", "license"} <= cited.keys()
    assert cited["cff-version"] == "1.2.0"
    assert all({"type", "title", "authors", "year"} <= one.keys() for one in cited["references"])
    who = [one["authors"][0]["family-names"] for one in cited["references"]]
    assert who == ["Yehoshua", "Shmuel"]


def test_version_and_licence_are_the_same_everywhere():
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert cited["version"] == project["version"]
    assert cited["license"] == project["license"] == "MIT"
    assert (ROOT / "LICENSE").read_text(encoding="utf-8").startswith("MIT License")
    latest = re.search(r"^## (\S+)", PAGES["CHANGELOG.md"], re.MULTILINE)[1].strip(",")
    assert latest == project["version"]


def cells(page):
    """Yield the lines of each cell of a notebook, and whether they are shown."""
    for cell in fences(page.read_text(encoding="utf-8"), "{code-cell}"):
        lines = re.sub(r"\A(?::\w+:.*\n)+", "", cell)
        yield lines, "remove-cell" not in cell.removesuffix(lines)


NOTEBOOKS = pytest.mark.parametrize(
    "page", sorted({*DOCS.glob("notebooks/*.md")} - {*DOCS.rglob("index.md")}), ids=lambda p: p.stem
)


@NOTEBOOKS
def test_the_cells_of_a_notebook_are_python(page):
    assert [ast.parse(lines) for lines, _ in cells(page)][1:]


@NOTEBOOKS
def test_the_cells_shown_of_a_notebook_need_nothing_of_those_that_are_not(page):
    known = {*vars(builtins)}
    for lines, shown in cells(page):
        if not shown:
            assert "sys.path" not in lines
            continue
        parts = [*ast.walk(ast.parse(lines))]
        known |= {one.asname or one.name for one in parts if isinstance(one, ast.alias)}
        known |= {one.arg for one in parts if isinstance(one, ast.arg)}
        names = [one for one in parts if isinstance(one, ast.Name)]
        known |= {one.id for one in names if isinstance(one.ctx, ast.Store)}
        assert {one.id for one in names} <= known
        assert "../../" not in lines
