"""Numbers as options: a refused one is said of the option as typed, and before anything is read."""

import re
from functools import cache

import pytest
import typer
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.cli.option_ranges import of_robot, refusing, within
from fieldmon.cli.worker_options import WorkerOptions
from fieldmon.decisions.sprayer import Sprayer, TreatmentCosts
from fieldmon.errors import SettingError
from fieldmon.io.spray_rate import RATE_L_HA
from fieldmon.monitoring import Application
from fieldmon.planning.members import Teamwork
from fieldmon.plot.planting import Planting
from fieldmon.plot.robot import Robot
from fieldmon.samplers import sampler
from tests.cli.wrong_lines import commands

#: what may well be below 0
_OF_BOTH_SIGNS = {"--bearing", "--canopy-below"}


def parsed(command, *words):
    """Read a line of a command, with something for all that it must have; run nothing."""
    needed = []
    for one in command.params:
        if one.required and one.opts[0] not in words:
            argument = one.param_type_name == "argument"
            needed += ["x"] if argument else [one.opts[0], "x"]
    return command.make_context("fieldmon", [*words, *needed]).params


def _holds_a_number(command, option):
    try:
        value = parsed(command, option.opts[0], "2")[option.name]
    except SettingError:
        return True
    except Exception:  # noqa: BLE001 - a flag, or one of some words
        return False
    one = value[0] if isinstance(value, list) else value
    return isinstance(one, int | float) and not isinstance(one, bool)


@cache
def numbers():
    """Return every number that a command takes: its words, the command, and the option."""
    return [
        (" ".join(words), command, one)
        for words, command in commands()
        for one in command.params
        if one.param_type_name == "option" and _holds_a_number(command, one)
    ]


def test_there_are_such_options_in_most_commands():
    assert len({words for words, _, _ in numbers()}) > 15
    assert {one.opts[0] for _, _, one in numbers()} > {"--speed", "--budget", "--per-ha", "--port"}


def _said(command, option, value):
    """Return what is said of a value; empty: it is taken."""
    usage = next(c for c in typer.BadParameter.__mro__ if c.__name__ == "ClickException")
    try:
        parsed(command, option, value)
    except SettingError as problem:
        return str(problem)
    except usage as problem:
        return problem.format_message()
    return ""


@pytest.mark.parametrize("value", ["nan", "inf", "-inf", "1e30", str(10**30), str(-(10**30))])
def test_what_no_number_of_the_field_can_be_is_refused_by_the_options_own_name(value):
    for words, command, one in numbers():
        said = _said(command, one.opts[0], value)
        assert one.opts[0] in said, (words, one.opts[0], said)


def test_no_number_is_below_nought_but_where_it_may_be():
    for words, command, one in numbers():
        said = _said(command, one.opts[0], "-1")
        name = one.opts[0]
        assert (name in said) == (name not in _OF_BOTH_SIGNS), (words, name, said)


def test_what_a_command_takes_by_itself_is_no_wrong_number():
    for words, command, one in numbers():
        if one.default is not None:
            assert not _said(command, one.opts[0], str(one.default)), (words, one.opts[0])


def _of(name):
    """Return a command that has an option."""
    return next(command for _, command, one in numbers() if one.opts[0] == name)


@pytest.mark.parametrize(
    ("option", "value", "says"),
    [
        ("--speed", "-1", "--speed must be above 0 km/h, but it is -1."),
        ("--speed", "1e30", "--speed must be 108 km/h at most, but it is 1e+30."),
        ("--look", "1e30", "--look must be 86400 s at most, but it is 1e+30."),
        ("--row-change", "-2", "--row-change must be 0 s or more, but it is -2."),
        ("--hours", "25", "--hours must be 24 h at most, but it is 25."),
        ("--width", "99", "--width must be 0.05 to 10 metres, but it is 99."),
        ("--spread", "-1", "--spread must be a chance in 0..1, but it is -1."),
        ("--row-spacing", "0", "--row-spacing must be 0.05 to 1000 metres, but it is 0."),
        ("--bearing", "400", "--bearing must be -360 to 360 degrees, but it is 400."),
        ("--contact", "1441", "--contact must be 1440 minutes at most, but it is 1441."),
        ("--every", "0", "--every must be 1 or more, but it is 0."),
        ("--sure", "0.5", "--sure must be a chance between 0.5 and 1, but it is 0.5."),
        ("--per-ha", "1e10", "--per-ha must be 1000000000 at most, but it is 1e+10."),
    ],
)
def test_a_number_is_refused_in_the_unit_in_which_it_was_given(option, value, says):
    assert _said(_of(option), option, value) == says


#: what is made of an option's number by the library, which must not be stricter than the option
_MADE_OF = {
    "--hours": lambda v: Robot(hours=v),
    "--look": lambda v: Robot(look_s=v),
    "--speed": lambda v: WorkerOptions(speed=v).robot(),
    "--turn": lambda v: Robot(turn_180_s=v),
    "--width": lambda v: Robot(width_m=v),
    "--turning-radius": lambda v: Robot(width_m=1.0, turning_radius_m=v),
    "--bearing": lambda v: Planting(row_bearing_deg=v),
    "--row-spacing": lambda v: Planting(row_spacing_m=v),
    "--headland": lambda v: Planting(headland_m=v),
    "--half-canopy": lambda v: Planting(half_canopy_m=v),
    "--contact": lambda v: Teamwork(contact_s=60 * v),
    "--passing": lambda v: Teamwork(passing_m=v),
    "--least-gain": lambda v: Teamwork(least_gain=v),
    "--every": lambda v: sampler("snake", every=int(v)),
    "--per-ha": lambda v: TreatmentCosts(per_ha=v),
    "--works": lambda v: TreatmentCosts(works=v),
    "--reserve": lambda v: TreatmentCosts(reserve=v),
    "--least-on": lambda v: Sprayer(least_on_m=v),
    "--ring": lambda v: Sprayer(ring=int(v)),
    "--water": lambda v: Application(water_l_ha=v),
    "--reentry-hours": lambda v: Application(reentry_hours=v),
    "--waiting-days": lambda v: Application(waiting_days=int(v)),
}


@pytest.mark.parametrize("option", _MADE_OF)
def test_a_number_that_an_option_takes_is_one_that_the_library_takes(option):
    command, made, taken = _of(option), _MADE_OF[option], 0
    for k in (0.0, 0.05, 0.5, 1.0, 10.0, 24.0, 100.0, 1e3, 3650.0, 1e4, 86_400.0, 1e6, 1e7, 1e9):
        value = int(k) if k == int(k) else k
        said = _said(command, option, str(value))
        if not said:
            made(k)
            taken += 1
    assert taken


@given(st.floats(allow_nan=True))
def test_a_number_is_taken_as_it_is_or_refused_each_of_several_too(value):
    class Option:
        opts = ("--rate",)

    inside = 0.0 < value < 100_000.0
    for told in (value, [1.0, value]):
        if inside:
            assert within(RATE_L_HA)(Option, told) is told
            continue
        with pytest.raises(SettingError, match=r"^--rate must be "):
            within(RATE_L_HA)(Option, told)
    assert refusing(lambda _: "")(Option, None) is None


def test_a_setting_of_the_robot_is_held_to_its_own_rule():
    class Option:
        opts = ("--speed",)

    assert of_robot("speed_m_s")(Option, 108.0) == 108.0
    with pytest.raises(SettingError, match=re.escape("--speed must be 108 km/h at most")):
        of_robot("speed_m_s")(Option, 108.1)
