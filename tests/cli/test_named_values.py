"""What is told as NAME=VALUE."""

import pytest

from fieldmon.cli.named_values import chosen, named_values
from fieldmon.errors import SettingError
from fieldmon.io.options import RecordOptions


def test_a_value_may_hold_the_sign_that_ends_the_name():
    assert list(named_values([" columns = date=Datum "])) == [("columns", "date=Datum")]
    assert list(named_values(None)) == []


def test_options_are_chosen_one_after_the_other():
    options = chosen(RecordOptions(), ["date_order=mdy", "columns=count=eggs", "columns=date=on"])
    assert options == RecordOptions(date_order="mdy", columns=(("count", "eggs"), ("date", "on")))


@pytest.mark.parametrize("flag", ["An option", "--risk-option"])
def test_what_has_no_value_is_a_sentence_with_the_option(flag):
    with pytest.raises(SettingError, match=f"{flag} must be NAME=VALUE, but it is 'crs'"):
        list(named_values(["crs"], flag))
