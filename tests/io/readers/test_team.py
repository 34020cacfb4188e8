"""Who is in a team, from a table as people write it."""

import pytest

from fieldmon.errors import FileProblem
from fieldmon.io.readers.team import read_team


def test_a_name_alone_is_as_those_of_the_season_are(tmp_path):
    (tmp_path / "t.csv").write_text("name\nr1\n\n#2\n", encoding="utf-8-sig")
    first, second = read_team(tmp_path / "t.csv")
    assert first == ("r1", "", {}, None, None, f"{tmp_path / 't.csv'}, line 2")
    assert second.name == "#2"


def test_what_is_stated_is_said_in_the_words_of_a_robot(tmp_path):
    (tmp_path / "t.csv").write_text(
        "Name;Who;speed_km_h;detection;start;lat;lon\nAnn;Scout;3,6;0,9;07:30;30.3;35.1\n"
    )
    (ann,) = read_team(tmp_path / "t.csv")
    assert ann.who == "scout"
    assert ann.settings == pytest.approx({"speed_m_s": 1.0, "detection": 0.9})
    assert (ann.start, ann.gate) == ("07:30", (35.1, 30.3))


def test_degrees_and_hours_are_no_thousands(tmp_path):
    (tmp_path / "t.csv").write_text("name;hours;lon;lat\na;7,125;35,123;30.345\n")
    (one,) = read_team(tmp_path / "t.csv")
    assert (one.settings, one.gate) == ({"hours": 7.125}, (35.123, 30.345))


def test_a_robot_has_a_size_and_times_of_its_own(tmp_path):
    (tmp_path / "t.csv").write_text(
        "name,width_m,length_m,turning_radius_m,row_change_s,turn_180_s,stop_s\n"
        "r,0.58,0.8,1.2,25,0,1.13\n"
    )
    (one,) = read_team(tmp_path / "t.csv")
    told = {"width_m": 0.58, "length_m": 0.8, "row_change_s": 25.0, "turn_180_s": 0.0}
    assert one.settings == told | {"stop_s": 1.13, "turning_radius_m": 1.2}


def test_a_file_that_is_no_text_is_refused(tmp_path):
    (tmp_path / "t.csv").write_bytes(b"\xff\xfe\x00\x81")
    with pytest.raises(FileProblem, match="must be a readable table"):
        read_team(tmp_path / "t.csv")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("name,lon,lat\n\na,35.1,nan\n", "line 3: lat must be a number, but it is 'nan'"),
        ("name,speed_km_h,hours\na,3,6,8\n", "line 2 has 4 cells, but there are 3 columns"),
        ("name,look_s\na,1.500\n", "line 2: look_s is 1.500: is that 1500 or 1.5"),
        ("name,width_m\na,58\n", "line 2: width_m must be 0.05 to 10"),
        ("name,hours,hours\na,3,4,5\n", "two columns are called hours"),
    ],
)
def test_a_table_that_is_wrong_says_where(tmp_path, text, said):
    (tmp_path / "t.csv").write_text(text)
    with pytest.raises(FileProblem, match=f"t.csv.*{said}"):
        read_team(tmp_path / "t.csv")
