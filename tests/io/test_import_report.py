"""What an import has to say, in a line, by its weight, and with what can be chosen instead."""

import pytest

from fieldmon.io.import_report import (
    Imported,
    Remedy,
    Severity,
    doubtful,
    dropped,
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
