"""What a signature names is what a caller must hand over; anything else is a sentence."""

import json
from dataclasses import dataclass, field
from datetime import date, datetime, time
from fractions import Fraction
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fieldmon.compute.kinds import checked, kind_of, must_be_of, must_hold_kinds
from fieldmon.errors import SettingError
from fieldmon.plot.robot import Robot

TODAY = date(2026, 11, 18)
#: annotations, what is of them, and what is not
KINDS = {
    "float": (
        [4, 4.5, np.float32(4), np.int16(3), Fraction(7, 2), float("inf")],
        ["4", None, True, np.True_, float("nan"), 1j, [4.0], 10**400, np.zeros(1)],
    ),
    "float | None": ([4.0, None], ["4", True]),
    "int": ([3, np.int64(3), -(10**30)], [3.0, "3", True, float("nan"), None]),
    "bool": ([True, np.False_], [1, 0, "yes", None]),
    "str": (["", "a"], [b"a", None, 3, ["a"], Path("a")]),
    "str | Path": (["a", Path("a")], [None, 3, b"a"]),
    "date": ([TODAY], [datetime(2026, 11, 18), pd.NaT, "2026-11-18", 3]),
    "time | None": ([time(6), None], [6, "6:00", TODAY]),
    "np.datetime64": ([np.datetime64("2026-11-18")], [np.datetime64("NaT"), TODAY, "2026-11-18"]),
    "Robot | None": ([Robot(), None], [4, "Robot", Robot]),
    "tuple[float, float]": ([(1, 2.5), [1, 2], np.zeros(2)], [(1,), (1, "2"), 3, np.zeros((2, 2))]),
    "tuple[str, ...]": ([(), ("a", "b"), ["a"]], ["ab", ("a", 3), {"a"}, None]),
    "Sequence[int]": ([[1, 2], ()], [{1}, 3, "12", [1.0]]),
    "Iterable[int]": ([[1], iter([1]), {1}], [3, "12", {1: 2}, [1.0], np.zeros((2, 2))]),
    "dict[str, float]": ([{}, {"a": 1}], [None, [], {"a": "b"}, {1: 2}]),
    "Callable[[int], None] | None": ([print, None], ["print", 3]),
    "Literal['each', 'one']": (["each"], ["all", ["each"], None]),
    "NDArray[np.float64]": ([np.zeros(3), np.zeros((2, 2), int)], [[0.0], np.zeros(2, bool), 3]),
    "NDArray[np.int32]": ([np.zeros(3, int)], [np.zeros(3), [1], pd.Series([1])]),
    "NDArray[np.bool_]": ([np.zeros(3, bool)], [np.zeros(3), np.zeros(3, int), [True]]),
    "NDArray[np.str_] | None": ([np.array(["a"]), None], [np.zeros(3), "a"]),
    "ArrayLike": ([[1], None, "a"], []),
}  # fmt: skip


@pytest.mark.parametrize("annotation", KINDS)
def test_a_kind_is_what_its_annotation_says(annotation):
    right, wrong = KINDS[annotation]
    fits = kind_of(annotation).fits
    assert [one for one in right if not fits(one)] == []
    assert [one for one in wrong if fits(one)] == []


@pytest.mark.parametrize(
    ("annotation", "given", "said"),
    [
        ("float", "4", "A day must be a number, but it is '4'."),
        ("int | None", 2.5, "A day must be a whole number, but it is 2.5."),
        ("Spread | None", 4, "A day must be a Spread, but it is 4. Give Spread(0.3)."),
        ("tuple[float, float]", "x", "A day must be a pair of numbers, but it is 'x'."),
        ("tuple[str, ...]", "4A", "A day must be a tuple of texts, but it is '4A'."),
        ("tuple[tuple[float, float], ...]", 3, ("A day must be a tuple of pairs of numbers, but it "
         "is 3.")),
        ("NDArray[np.bool_]", [1], "A day must be an array of True and False, but it is a list."),
        ("float", 10**400, ("A day must be a number of less than 300 digits, but it is "
         f"1{'0' * 39}....")),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_with_what_must_hold_and_what_was_found(annotation, given, said):
    with pytest.raises(SettingError) as refused:
        must_be_of("A day", annotation, given)
    assert str(refused.value) == said


@dataclass(frozen=True)
class _Settings:
    hours: "float" = 4.0
    rows: "int | None" = None
    name: "str" = ""

    def __post_init__(self):
        must_hold_kinds(self, "The robot's")


@pytest.mark.parametrize("bad", [{"hours": "4"}, {"rows": [1]}, {"name": 3}])
def test_a_setting_of_another_kind_is_named(bad):
    (name,) = bad
    with pytest.raises(SettingError, match=f"^The robot's {name} must be"):
        _Settings(**bad)


@dataclass(frozen=True)
class _Kept:
    hours: "float | None" = 4.0
    seed: "int" = 1
    traced: "bool" = True
    name: "str" = ""
    begins: "date | None" = None
    starts: "time" = time(6)
    gate: "tuple[float, float] | None" = None
    steps: "tuple[tuple[float, float], ...]" = ()
    settings: "dict[str, float]" = field(default_factory=dict)

    def __post_init__(self):
        must_hold_kinds(self, "A season's")


def test_a_dataclass_keeps_what_can_be_written_and_what_nobody_can_change():
    steps, settings = [[np.float32(20), 0.5], (25, np.float64(0.75))], {"every": np.int64(3)}
    made = _Kept(
        np.int64(4), np.uint8(2), np.False_, np.str_("a"), np.datetime64("2026-11-18"), "7:00",
        np.array([35.5, 30.5]), steps, settings,
    )  # fmt: skip
    steps[1], settings["every"] = (1.0, 1.0), 9
    assert made == _Kept(
        4, 2, False, "a", TODAY, time(7), (35.5, 30.5), ((20.0, 0.5), (25, 0.75)), {"every": 3}
    )
    assert repr(made) == repr(_Kept(**vars(made)))
    assert "np." not in repr(made)
    assert json.dumps([made.hours, made.seed, made.gate, made.steps, made.settings])
    # what is such already stays the same thing
    again = _Kept(**vars(made))
    assert again.steps is made.steps
    assert _Kept(Fraction(7, 2)).hours == 3.5


@pytest.mark.parametrize("begins", ["soon", 20_000, pd.NaT])
def test_a_dataclass_takes_days_as_functions_do(begins):
    for given in ("2026-11-18", "2026-11-18T06:00", datetime(2026, 11, 18, 6), TODAY):
        assert _Kept(begins=given).begins == TODAY
    with pytest.raises(SettingError, match=r"^A season's begins must be a date, but it is "):
        _Kept(begins=begins)
    with pytest.raises(SettingError, match=r'^A season\'s starts must be a time.*Give "06:00"'):
        _Kept(starts="soon")


@checked
class _Season:
    @property
    def days(self) -> "int":
        return 3

    def plan(self, on: "date", *, keep: "bool" = True) -> "str":
        """Plan a day."""
        return f"{on} {keep}"

    @classmethod
    def create(cls, path: "str", **chosen: "int") -> "object":
        return iter([len(path), *chosen])

    @staticmethod
    def hours(of: "int") -> "int":
        return of


class _LongSeason(_Season):
    pass


def test_methods_refuse_what_they_are_not_annotated_with_and_stay_what_they_were():
    season = _LongSeason()
    assert season.plan(TODAY) == season.plan(on=TODAY, keep=True) == "2026-11-18 True"
    for day in ("2026-11-18", np.datetime64("2026-11-18T06"), datetime(2026, 11, 18, 6),
                pd.Timestamp("2026-11-18")):  # fmt: skip
        assert season.plan(day) == season.plan(on=day) == season.plan(TODAY)
    assert (season.days, season.hours(3), next(_Season.create("ab"))) == (3, 3, 2)
    assert (_Season.plan.__doc__, _Season.plan.__qualname__) == ("Plan a day.", "_Season.plan")
    for call, said in (
        (
            lambda: season.plan("soon"),
            "'on' of _LongSeason.plan must be a date, but it is 'soon'",
        ),
        (
            lambda: season.plan(np.datetime64("NaT")),
            "'on' of _LongSeason.plan must be a date, but it is NaT",
        ),
        (lambda: season.plan(pd.NaT), "'on' of _LongSeason.plan must be a date"),
        (lambda: season.plan(TODAY, keep=1), "'keep' of _LongSeason.plan must be True or False"),
        (lambda: _Season.create(path=3), "'path' of _Season.create must be text, but it is 3"),
    ):
        with pytest.raises(SettingError) as refused:
            call()
        assert str(refused.value).startswith(said)


def test_what_does_not_fit_a_signature_at_all_is_pythons_own_error():
    with pytest.raises(TypeError, match="unexpected keyword"):
        _Season().plan(TODAY, hours=4)
