"""How many each record counts, and whether it found any: read, asked about or doubted."""

import numpy as np
import pytest

from fieldmon.errors import ChoiceNeeded
from fieldmon.infestation.records import ABSENT, PRESENT, UNKNOWN
from fieldmon.io.import_report import Severity
from fieldmon.io.options import RecordOptions
from fieldmon.io.readers.places import NamedPlaces
from fieldmon.io.readers.records import records_of
from tests.io.readers.read_records import ANY, at, read, said, vines
from tests.io.tables_of_cells import sentences, table

DETECTED = {"class": ["mite", "background", "mite"], "confidence": [0.54, 0.83, 0.78]}


def test_zero_is_absent_and_nothing_is_not_known():
    records = read(count=[3, 0, None, "0", "n/a", ""]).value
    assert records.present.tolist() == [PRESENT, ABSENT, UNKNOWN, ABSENT, UNKNOWN, UNKNOWN]
    np.testing.assert_array_equal(records.count, [3, 0, np.nan, 0, np.nan, np.nan])


def test_a_word_says_whether_where_no_count_does():
    records = read(present=["yes", "no", "", "maybe"])
    assert records.value.present.tolist() == [PRESENT, ABSENT, UNKNOWN, UNKNOWN]
    assert "neither yes nor no: 'maybe'" in said(records, Severity.DOUBTFUL)


def test_all_words_that_say_neither_are_asked_about_at_once_and_those_said_before_stay():
    cells = ["yes", "perhaps", "krobbig", "a, b", "no"]
    (odd,) = [one for one in read(present=cells).messages if one.remedy is not None]
    assert odd.remedy.setting == r'"found=a\, b,krobbig,perhaps"'
    told = read(RecordOptions(found="krobbig"), present=cells)
    assert told.value.present.tolist() == [PRESENT, UNKNOWN, PRESENT, UNKNOWN, ABSENT]
    (odd,) = [one for one in told.messages if one.remedy is not None]
    assert odd.remedy.setting == r'"found=krobbig,a\, b,perhaps"'
    told = read(RecordOptions(found=odd.remedy.value), present=cells)
    assert told.value.present.tolist() == [PRESENT, PRESENT, PRESENT, PRESENT, ABSENT]


def test_nothing_of_a_leaf_is_clean_and_any_part_of_it_a_find():
    records = read(severity=["0%", "30 %", "0,0 %", "100%", ""])
    assert records.value.present.tolist() == [ABSENT, PRESENT, ABSENT, PRESENT, UNKNOWN]
    assert np.isnan(records.value.count).all()
    assert "neither" not in said(records, Severity.DOUBTFUL)
    assert "no plain number ('30%')" in said(read(count=["30%", "2"]), Severity.DOUBTFUL)


def test_waypoints_say_in_their_names_what_was_found_where_nothing_else_does():
    records = read(name=["+3", "-", "0", "clean", "R3/17 +", "007"])
    assert records.value.present.tolist() == [PRESENT, ABSENT, ABSENT, ABSENT, PRESENT, UNKNOWN]
    np.testing.assert_array_equal(records.value.count, [3, *[np.nan] * 5])
    (guess,) = [one for one in records.of(Severity.GUESSED) if one.feature == "name"]
    assert (guess.remedy.option, guess.remedy.value) == ("columns", "present=")
    every = read(ANY.choose("columns", "present="), name=["+3", "-", "0", "clean"])
    assert every.value.present.tolist() == [PRESENT] * 4
    # of others a word here and there says nothing
    with pytest.raises(ChoiceNeeded) as asked:
        read(name=["gate", "shed", "x", "tank"])
    assert "present=name" not in asked.value.choices


def test_a_word_that_contradicts_its_count_is_doubted_and_believed():
    records = read(count=[3, 0, 2], present=["yes", "yes", None])
    assert records.value.present.tolist() == [PRESENT, PRESENT, PRESENT]
    assert "1 record contradicts its own count" in said(records, Severity.DOUBTFUL)


def test_a_file_that_only_lists_places_asks_what_was_found_and_offers_what_could_be_a_count():
    with pytest.raises(ChoiceNeeded, match="says what was found") as asked:
        read(zz=[1, 2, 3], crop=["a", "b", "c"])
    counted, all_finds = asked.value.choices
    assert (counted, all_finds) == ("count=zz", "present=")
    again = records_of(at(3, zz=[1, 0, 3]), ANY.choose("columns", counted))
    assert again.value.present.tolist() == [PRESENT, ABSENT, PRESENT]
    again = records_of(at(3, zz=[1, 0, 3]), ANY.choose("columns", all_finds))
    assert (again.value.present == PRESENT).all()


def test_what_a_robot_saw_is_asked_for_in_words_that_answer_and_never_taken_from_its_confidence():
    with pytest.raises(ChoiceNeeded) as asked:
        read(**DETECTED)
    assert asked.value.choices == ("present=class", "present=")
    for role in ("present", "found", "result"):
        imported = read(RecordOptions(columns=((role, "class"),)), **DETECTED)
        assert imported.value.present.tolist() == [PRESENT, ABSENT, PRESENT]
        unused = [one.feature for one in imported.messages if "is not used" in one.sentence]
        assert unused == ["confidence"]
    told = read(ANY.naming(count="confidence"), **DETECTED)
    assert "as confidences are" in said(told, Severity.DOUBTFUL)
    assert "is not used" not in said(told, Severity.SEEN)
    assert "as confidences" not in said(read(mites=[0.5, 0.1, 0]), Severity.DOUBTFUL)


def test_a_count_that_is_no_plain_number_is_read_roughly_and_shown():
    records = read(count=["3", "~10", ">5", "many"])
    assert "no plain number" in said(records, Severity.DOUBTFUL)
    assert (records.value.present[:3] == PRESENT).all()


def test_a_number_that_nobody_counts_is_left_open_and_shown():
    records = read(count=["3", "1e308", "0"])
    assert "1 count says neither how many nor whether any ('1e308')" in said(
        records, Severity.DOUBTFUL
    )
    assert records.value.present.tolist() == [PRESENT, UNKNOWN, ABSENT]
    assert np.isnan(records.value.count[1])


def test_a_comma_is_what_the_rest_of_the_table_says_it_is_and_else_a_guess():
    np.testing.assert_allclose(read(count=["1,5", "1,234"]).value.count, [1.5, 1.234])
    assert read(count=["1,234", "7"]).value.count.tolist() == [1234.0, 7.0]  # as in 35.150123
    half = read(count=["0,500", "7"])
    assert half.value.count.tolist() == [0.5, 7.0]  # no thousands begin so
    both = read(count=["2,5", "1,234", "3.000"])
    assert both.value.count.tolist() == [2.5, 1.234, 3000.0]
    assert "Counts such as 3.000 were read as thousands" in said(both, Severity.GUESSED)
    average = RecordOptions(columns=(("count", "average"),))
    assert read(average, average=["1.250", "2.333"]).value.count.tolist() == [1.25, 2.333]
    layer, places = table(plant=["1", "2"], count=["1,234", "7"]), NamedPlaces(plants=vines(5.0))
    alone = records_of(layer, ANY, places)
    assert alone.value.count.tolist() == [1234.0, 7.0]
    (guess,) = [m for m in alone.of(Severity.GUESSED) if "thousands" in m.sentence]
    options = ANY.choose(guess.remedy.option, guess.remedy.value)
    assert records_of(layer, options, places).value.count.tolist() == [1.234, 7.0]


def test_results_that_could_be_confidences_are_doubted():
    assert "are confidences" in said(read(detection=[0.0, 0.03, 0.08]), Severity.DOUBTFUL)
    for unsure in ([0.0, 0.03, 0.08], [0.03, 1, 2, "yes"], ["3%", "0%", "no"], ["3 \u066a"]):
        records = read(result=unsure)
        assert f"such as '{unsure[0] or 0.03}'" in said(records, Severity.DOUBTFUL)
    assert "confidences" not in sentences(read(result=[0, 1, 2, "yes"]))


def test_what_is_no_count_is_not_said_to_be_read_roughly():
    records = read(count=["<5", "5+", "TNTC", "-3", "4"])
    assert records.value.present.tolist() == [PRESENT, PRESENT, UNKNOWN, UNKNOWN, PRESENT]
    doubts = said(records, Severity.DOUBTFUL)
    assert "2 counts say neither how many nor whether any ('TNTC', '-3'); left open." in doubts
    assert "2 counts are no plain number ('<5', '5+'); read roughly." in doubts


def test_a_count_that_often_stands_for_no_value_is_left_open_and_said():
    records = read(count=[12, 9999, 0, 9999])
    assert records.value.present.tolist() == [PRESENT, UNKNOWN, ABSENT, UNKNOWN]
    np.testing.assert_array_equal(records.value.count, [12, np.nan, 0, np.nan])
    doubt = said(records, Severity.DOUBTFUL)
    assert "2 counts are 9999, which often stands for no value" in doubt
    assert read(count=[1500, 9999]).value.present.tolist() == [PRESENT, PRESENT]
