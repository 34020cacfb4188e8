"""Pests are read from TOML with a source for each part, and refused with the line."""

import re

import pytest

from fieldmon.errors import FileProblem
from fieldmon.io.packaged import pest_names
from fieldmon.io.readers.pest_file import pest_from_text, pest_of, read_pest, shipped_pest
from fieldmon.plot.robot import Robot
from tests.docs.pages import PAGES, the_fence

#: a year, a page, or that nobody published it
FOUND_AGAIN = re.compile(r"\b(19|20)\d\d\b|our choice|article_|two-sex life table", re.IGNORECASE)
TEXT = """\
name = "mite"
title = "A mite"

[[stages]]
name = "egg"
threshold_c = 12.5
degree_days = 60
visible = false

[[stages]]
name = "young"
threshold_c = 12.5
degree_days = 86.5

[increase]
at_c = [15, 30]
per_day = [0.08, 0.321]

[movement]
kernel = "exponential"
reach_m = 3
per_day = 0.1

[detection]
viewpoints = [[20, 0.5], [40, 0.8]]
longer = 0.9

[sources]
stages = "Somebody 2001"
increase = "Somebody 2001"
movement = "Our choice"
detection = "Somebody 2003"

[doubts]
movement = "Nobody measured it."
"""


def refused(old, new, text=TEXT):
    """Return the line and the sentence with which a changed file is refused."""
    assert old in text
    with pytest.raises(FileProblem) as problem:
        pest_from_text(text.replace(old, new, 1), "mite.toml")
    said = re.fullmatch(r"mite\.toml, line (\d+): (.+)", str(problem.value), re.DOTALL)
    assert said, str(problem.value)
    return int(said[1]), said[2]


def test_a_pest_is_what_its_file_says():
    pest = pest_from_text(TEXT, "mite.toml")
    assert [stage.degree_days for stage in pest.stages] == [60, 86.5]
    assert not pest.stages[0].visible
    assert float(pest.increase.at(22.5)) == pytest.approx((0.08 + 0.321) / 2)
    assert pest.movement.reach_m == 3
    assert pest.viewpoints.detection(41) == 0.9
    assert pest.source("movement").doubt == "Nobody measured it."
    assert pest.source("entry") is None


@pytest.mark.parametrize(
    ("old", "new", "line", "sentence"),
    [
        ("threshold_c = 12.5", "threshold_f = 54.5", 6,
         "another unit than fieldmon reads: convert it to degrees Celsius, as threshold_c"),
        ("per_day = [0.08, 0.321]\n\n[movement]",
         "per_day = [0, 0.321]\n\n[movement]\nat_c = 15", 20,
         "at_c of movement must be a temperature at which the pest increases"),
        ("threshold_c = 12.5", "threshold_c = 54.5", 6, "Is it in Fahrenheit?"),
        ("threshold_c = 12.5", 'threshold_c = "54.5 F"', 6,
         "must be a number in degrees Celsius, without quotes"),
        ("reach_m = 3", "reach_ft = 10", 21, "convert it to metres, as reach_m"),
        ("degree_days = 86.5", "degree_days = -86.5", 13, "must be above 0, but it is -86.5"),
        ("per_day = [0.08, 0.321]", "per_day = [0.08, -0.321]", 17, "must be 0 to 2"),
        ("per_day = [0.08, 0.321]", "per_day = [0.08]", 16, "as many rates per_day"),
        ("at_c = [15, 30]", "at_c = [30, 15]", 16, "must rise"),
        ("per_day = 0.1", "per_day = -0.1", 22, "must be 0 or more, but it is -0.1"),
        ("per_day = 0.1", "per_day = nan", 22, "but it is nan"),
        ('kernel = "exponential"', 'kernel = "gaussian"', 20,
         "A kernel must be one of adjacent, exponential, cauchy, but it is 'gaussian'"),
        ("reach_m = 3\n", "", 20, "must have a reach_m"),
        ("kernel =", "kernal =", 20, "Is it kernel?"),
        ('stages = "Somebody 2001"\n', "", 4, "[stages] has no source"),
        ('movement = "Our choice"', 'movement = " "', 19, "[movement] has no source"),
        ('increase = "Somebody 2001"', 'entry = "Somebody 2001"', 30, "no part of this pest"),
        ("visible = false", 'visible = "no"', 8, "must be true or false"),
        ('[[stages]]\nname = "egg"', '[stages]\nname = "egg"', 1, ""),
        ("viewpoints = [[20, 0.5], [40, 0.8]]", "viewpoints = [[40, 0.5], [20, 0.8]]", 25,
         "both rising"),
        ("viewpoints = [[20, 0.5], [40, 0.8]]", "viewpoints = [20, 0.5]", 25, "must be pairs"),
        ('name = "mite"\n', "", 1, "must have a name"),
        ("[detection]", "[detections]", 24, "Is it detection?"),
        ('title = "A mite"', "title = 3", 2, "must be text in quotes"),
        ("degree_days = 60\n", "", 4, "must say its degree_days"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_with_its_line(old, new, line, sentence):
    if "[stages]\nname" in new:
        text = TEXT[: TEXT.index('[[stages]]\nname = "young"')] + '[sources]\nstages = "S"\n'
        at, said = refused(old, new, text)
        assert (at, "double brackets" in said) == (4, True)
        return
    at, said = refused(old, new)
    assert sentence in said
    assert at == line


def test_what_is_no_toml_is_said_with_its_line():
    with pytest.raises(FileProblem, match=r"must be TOML, but it is not: .*line 2"):
        pest_from_text('name = "mite"\ntitle = A mite\n', "mite.toml")


def test_text_of_several_lines_does_not_shift_lines():
    at, _ = refused("per_day = 0.1", "per_day = -1", TEXT.replace(
        'title = "A mite"', 'title = """A\n[movement]\nper_day = 2\n"""'))  # fmt: skip
    assert at == 25


def test_a_name_that_is_neither_file_nor_pest_lists_the_pests(tmp_path):
    with pytest.raises(FileProblem, match=r"one of thesis, spider-mite, .*; but it is 'mote'"):
        pest_of("mote")
    path = tmp_path / "mite.toml"
    path.write_text(TEXT, encoding="utf-8")
    assert pest_of(str(path)) == read_pest(path)
    path.write_bytes(b"\xff\xfe name")
    with pytest.raises(FileProblem, match="text in UTF-8"):
        read_pest(path)


@pytest.mark.parametrize("name", pest_names())
def test_each_pest_that_comes_along_says_its_sources_and_is_called_as_its_file(name):
    pest = shipped_pest(name)
    assert pest.name == name
    assert pest.title
    assert pest.not_found
    assert pest.citations
    for citation in pest.citations:
        assert citation.source
        # what somebody else published can be found again, what is our choice says so
        assert re.search(
            r"\b(19|20)\d\d\b|our choice|article_|two-sex life table",
            citation.source,
            re.IGNORECASE,
        )
        if "our choice" in citation.source.casefold() and "rate" in citation.source:
            assert citation.doubt


def test_the_spider_mites_figures_are_the_published_ones():
    pest = pest_of("spider-mite")
    assert (pest.generation.degree_days, pest.generation.threshold_c) == (146.48, 12.5)
    assert pest.increase.at(15.0) == 0.08
    assert pest.increase.at(30.0) == 0.321
    # 2 % to each of four neighbours is 8 % a day at 15 °C: as mites multiply
    assert 4 * pest.infests_per_day(15.0) == pytest.approx(0.08)
    assert 4 * pest.infests_per_day(30.0) == pytest.approx(0.321, rel=0.05)


def test_the_thesiss_pest_is_the_thesiss_rule_and_its_robot_the_same():
    pest = pest_of("thesis")
    assert (pest.movement.kernel, pest.movement.per_day) == ("adjacent", 0.5)
    assert float(pest.infests_per_day(5.0)) == 0.5
    assert pest.seen_by(Robot()) == Robot()


def test_the_example_of_the_documentation_is_a_pest():
    example = the_fence(PAGES["docs/own_pest.md"], "toml", "[[stages]]")
    pest = pest_from_text(example, "example.toml")
    assert pest.movement.hours == (8, 18)
    assert pest.entry.anywhere_per_day == 0.0002
    assert {one.part for one in pest.citations} == {
        "stages", "generation", "increase", "movement", "entry", "detection", "course"
    }  # fmt: skip
