"""Thresholds: the published ones with their sources, and one's own."""

import pytest

from fieldmon.decisions.thresholds import (
    Threshold,
    in_order_for,
    published,
    read_thresholds,
    threshold_of,
)
from fieldmon.errors import FileProblem, SettingError
from fieldmon.io.packaged import pest_names

NAMES = "name,measure,level,source"


def test_the_published_ones_are_those_of_their_sources():
    almond = threshold_of("almond")
    assert almond.level == 0.22
    assert "Zalom" in almond.source
    assert threshold_of("almond with predators").level == 0.436
    assert threshold_of("peppermint").level == 5
    assert [threshold_of(f"strawberry {when}").level for when in ("before fruit", "in fruit")] == [
        5,
        15,
    ]
    assert all(one.source for one in published())


def test_the_published_ones_name_pests_of_fieldmon_and_those_of_the_season_s_come_first():
    assert {pest for one in published() for pest in one.pests} <= {*pest_names()}
    mine = Threshold("mine", "share of plants", 0.1, pest="whitefly")
    anyones = Threshold("anyone's", "share of plants", 0.1, pest="mites and all that")
    known = (*published(), mine, anyones)
    assert in_order_for("whitefly", known) == (mine, anyones, *published())
    assert in_order_for("spider-mite", known) == (*published(), anyones, mine)
    assert in_order_for("", known) == known
    almond = threshold_of("almond")
    assert almond.doubt("whitefly") == (
        "The action threshold 'almond' is for spider-mite, thesis, but the season's pest is "
        "whitefly: take one for it, or a share of the plants."
    )
    assert almond.doubt("thesis") == almond.doubt("") == anyones.doubt("whitefly") == ""


def test_a_share_of_the_plants_is_a_threshold_of_ones_own():
    own = threshold_of("2.5 %")
    assert own == Threshold("2.5 %", "share of plants", 0.025)
    assert own.sentence() == "Treat from 2.5 % of the plants infested on (your own)."
    assert threshold_of("peppermint").sentence().startswith("Treat from 5 a leaf on (Tollerup")


@pytest.mark.parametrize("said", ["0%", "100%", "120%", "x%", "rose", "5"])
def test_what_is_no_threshold_is_refused(said):
    with pytest.raises(SettingError, match="threshold"):
        threshold_of(said)


def test_the_level_of_a_share_may_be_percents(tmp_path):
    path = tmp_path / "own.csv"
    path.write_text("name;measure;level;source\nours;share of plants;3,6 %;me\n", encoding="utf-8")
    assert read_thresholds(path)[0].level == pytest.approx(0.036)
    path.write_text("name;measure;level;source\nours;share of plants;3.625%;me\n", encoding="utf-8")
    assert read_thresholds(path)[0].level == pytest.approx(0.03625)
    path.write_text("name;measure;level;source\nours;mean per leaf;3,6 %;me\n", encoding="utf-8")
    with pytest.raises(FileProblem, match="level must be a number"):
        read_thresholds(path)


def test_ones_own_are_read_from_a_file(tmp_path):
    path = tmp_path / "own.csv"
    path.write_text(
        "# ours\nname;measure;level;source\ntomato;share of plants;0,04;ours\n",
        encoding="utf-8-sig",
    )
    (own,) = read_thresholds(path)
    assert threshold_of("tomato", [own]) is own
    assert own == Threshold("tomato", "share of plants", 0.04, "ours")


@pytest.mark.parametrize(("said", "meant"), [("5", "5"), ("0.05", "5"), ("2,5", "2.5")])
def test_a_number_alone_may_be_a_share(said, meant):
    with pytest.raises(SettingError, match=rf"it is '{said}'\. Did you mean {meant}%\?$"):
        threshold_of(said)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("name,level\na,1\n", "no measure and no source"),
        (f"{NAMES}\na,share of plants,much,b\n", "line 2: level must be"),
        (f"{NAMES}\na,share of plants\n", "line 2: level must be a number, but it is ''"),
        (f"{NAMES}\na,share of plants,nan\n", "line 2: level must be a number"),
        (f"{NAMES}\na,mean per leaf,1.250,b\n", "line 2: level is 1.250: is that 1250 or 1.25"),
        (f"{NAMES}\na,mites,1,b\n", "line 2: .*must count one of"),
        (f"{NAMES}\na,share of plants,4,b\n", "must be above 0 and below 1"),
        (f"{NAMES}\na,share of plants,0.1,\na,share of plants,0.2,\n", "two thresholds are called"),
        (f"{NAMES}\n", "must hold a threshold or more"),
    ],
)
def test_a_file_that_is_wrong_says_where(tmp_path, text, said):
    path = tmp_path / "own.csv"
    path.write_text(text)
    with pytest.raises(FileProblem, match=f"own.csv.*{said}"):
        read_thresholds(path)
    with pytest.raises(FileProblem, match=r"none.csv"):
        read_thresholds(tmp_path / "none.csv")
