"""The table of a team is read back as it was written."""

from hypothesis import given
from hypothesis import strategies as some

from fieldmon.io.readers.team import SETTINGS, StatedMember, team_of_table
from fieldmon.io.writers.team import team_csv
from fieldmon.plot.robot import SAID_IN

NAMES = ("=SUM(A1)", "-2", "Ann, Bo", 'Ann "the eye"', "#2", "נועה", "a;b", "'quoted'")


def test_names_that_a_table_or_a_spreadsheet_takes_for_something_else_come_back():
    stated = tuple(
        StatedMember(name, "scout", {}, "06:05", (35.123, -30.5), f"team.csv, line {k}")
        for k, name in enumerate(NAMES, 2)
    )
    written = team_csv(stated)
    assert team_of_table(written, "team.csv") == stated
    assert b"\r\n'=SUM(A1),scout" in written


SAID = {name: some.floats(0.1, 0.9 * SAID_IN[name].most) for name in SETTINGS.values()}


@given(some.fixed_dictionaries({}, optional=SAID))
def test_every_setting_comes_back_to_the_last_bit(said):
    settings = {name: value / SAID_IN[name].units for name, value in said.items()}
    stated = (StatedMember("Ann", "", settings, None, None, "team.csv, line 2"),)
    assert team_of_table(team_csv(stated), "team.csv") == stated


def test_a_fraction_that_might_be_thousands_is_none():
    (ann,) = team_of_table(b"name,look_s\nAnn,31.1250\n", "team.csv")
    assert b"31.1250" in team_csv([ann])
