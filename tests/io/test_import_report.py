"""What an import has to say, in a line, by its weight, and with what can be chosen instead."""

import pytest

from fieldmon.io.import_report import (
    Imported,
    Remedy,
    Severity,
    doubtful,
    dropped,
    gathered,
    guessed,
    repaired,
    seen,
)
from fieldmon.io.options import PlotOptions, RecordOptions

MAKERS = {
    Severity.SEEN: seen,
    Severity.REPAIRED: repaired,
    Severity.GUESSED: guessed,
    Severity.DROPPED: dropped,
    Severity.DOUBTFUL: doubtful,
}
REMEDY = Remedy("date_order", "mdy", "Read month first", ("ymd",))


@pytest.mark.parametrize("severity", Severity)
def test_a_message_begins_with_its_weight_and_whom_it_is_about(severity):
    message = MAKERS[severity]("It was so.", "plot 3")
    assert message.severity is severity
    assert str(message) == f"{severity.value}: plot 3: It was so."
    assert str(MAKERS[severity]("It was so.")) == f"{severity.value}: It was so."


def test_a_remedy_stands_behind_its_flag_as_one_types_it():
    message = guessed("Day first.", "date", REMEDY)
    wanted = "guessed: date: Day first. (Read month first: --record-option date_order=mdy)"
    assert message.line("--record-option") == wanted
    assert message.line() == wanted.replace("--record-option ", "")


@pytest.mark.parametrize(
    ("value", "typed"),
    [("EPSG:2039", "crs=EPSG:2039"), ("a b", '"crs=a b"'), ("x;y", '"crs=x;y"')],
)
def test_what_a_shell_would_cut_is_quoted(value, typed):
    assert Remedy("crs", value, "").setting == typed


def test_every_choice_of_a_remedy_can_be_chosen():
    assert REMEDY.choices == ("mdy", "ymd")
    for choice in REMEDY.choices:
        assert RecordOptions().choose(REMEDY.option, choice).date_order == choice
    columns = Remedy("columns", "plot=", "No column names a plot")
    assert PlotOptions().choose(columns.option, columns.value).column("plot") == ""


def test_the_worst_of_an_import_is_its_gravest_message():
    messages = (seen("a"), dropped("b"), guessed("c"))
    assert Imported(1, messages).worst is Severity.DROPPED
    assert Imported(1).worst is None
    assert [severity.rank for severity in Severity] == sorted(s.rank for s in Severity)
    assert Severity.DOUBTFUL.rank == max(severity.rank for severity in Severity)


def test_another_value_keeps_what_was_said_before_it():
    first = Imported("x", (seen("a"), dropped("b")))
    other = first.having(2, [guessed("c")])
    assert other.value == 2
    assert [message.sentence for message in other.messages] == ["a", "b", "c"]
    assert [message.sentence for message in other.of(Severity.SEEN, Severity.GUESSED)] == ["a", "c"]
    assert len(first.messages) == 2


MANY = "{n} shapes were mended"


def test_messages_of_one_kind_are_one_with_their_number_and_the_first_of_them():
    said = [doubtful(f"It was {i}.", f"plot {i}", many=MANY) for i in range(3)]
    (one,) = gathered(said)
    assert str(one) == "doubtful: 3 shapes were mended; the first is plot 0: It was 0."


def test_one_alone_and_messages_about_the_file_stay_as_they_are_and_in_their_place():
    alone = doubtful("It was mended.", "plot 1", many=MANY)
    whole = seen("Heights are not used.")
    assert gathered([whole, alone, whole]) == (whole, alone, whole)


def test_what_differs_in_severity_or_in_its_remedy_is_not_one():
    remedy = Remedy("crs", "EPSG:1", "Read as that")
    said = [doubtful("x", "a", None, MANY), dropped("x", "b", None, MANY)]
    said.append(doubtful("x", "c", remedy, MANY))
    assert gathered(said) == tuple(said)
