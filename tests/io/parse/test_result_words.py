"""Words for what was found, whatever the language: one meaning each."""

import pytest

from fieldmon.infestation.records import ABSENT, PRESENT
from fieldmon.io.options import RecordOptions
from fieldmon.io.parse.result_words import (
    CLEAN,
    FOUND,
    MAYBE_GONE,
    NOT_INSPECTED,
    ResultWords,
    gone_note,
    is_gone,
    meaning,
    says_gone,
)


def test_no_word_says_two_things():
    assert not FOUND.keys() & CLEAN.keys()
    assert not NOT_INSPECTED & (FOUND.keys() | CLEAN.keys())
    assert not MAYBE_GONE & (FOUND.keys() | CLEAN.keys() | NOT_INSPECTED)


@pytest.mark.parametrize(
    ("note", "is_gone"),
    [
        *((n, True) for n in ("gone", "Gone.", "GONE: burnt", "missing", "Plant missing", "dead")),
        *((n, True) for n in ("tree is dead", "The plant was removed!", "dead - replant", "falta")),
        *((n, True) for n in ("planta muerta", "La planta ya no está", "העץ מת", "הצמח נעקר")),
        *((n, True) for n in ("الشجرة ميتة", "thorns; missing (Ben)", "Gone, cut last week")),
        *((n, False) for n in ("", "dead?", "dead branches", "not dead", "key missing", "plant")),
        *((n, False) for n in ("locked: dead dog", "thorns", "no", "?")),
    ],
)
def test_a_note_says_that_a_plant_is_gone_in_the_words_that_people_use(note, is_gone):
    assert says_gone(note) == is_gone
    assert says_gone(gone_note(note))


@pytest.mark.parametrize(
    ("word", "says"),
    [
        *(
            (w, PRESENT)
            for w in ("Sì", "POSITIF", "positiva", "infestado", "да", "有", "نعم", "हाँ")
        ),
        *((w, PRESENT) for w in ("befallen", "aangetast", "evet", "nachweis", "נגוע", "+")),
        # found and only flagged, as a season calls it that does not treat its finds
        *((w, PRESENT) for w in ("Flagged", "marcada", "marcado", "מסומן", "סומן", "مُعلَّمة")),
        *((w, PRESENT) for w in ("markiert", "marqué", "segnalata", "отмечено", "标记")),
        *((w, ABSENT) for w in ("NEG", "Négatif", "sano", "негатив", "无", "لا", "नहीं", "hayır")),
        *(
            (w, ABSENT)
            for w in ("gesund", "schoon", "não", "sain", "pulita", "zdrowy", "Not_found.")
        ),
        *((w, ABSENT) for w in ("not infested", "No infestation.", "none found", "no mites")),
        *((w, ABSENT) for w in ("kein Befund", "nicht befallen", "sin plaga", "non infesté")),
        *((w, ABSENT) for w in ("לא נגוע", "אין נגיעות", "غير مصاب", "لا توجد إصابة")),
    ],
)
def test_a_word_is_known_in_any_case(word, says):
    assert meaning(word) == says


def test_what_could_not_be_inspected_and_what_maps_of_ours_show_are_known():
    skipped = "übersprungen sautée saltato pulado pominięto atlandı пропущено דולגה 跳过"
    assert not {*skipped.split(), "could not inspect", "plant is gone"} - NOT_INSPECTED
    assert is_gone("Plant is gone")
    assert (meaning("found infested"), meaning("looked clean")) == (PRESENT, ABSENT)


def test_words_of_ones_own_go_before_all_others():
    words = ResultWords(["x", "-"], RecordOptions(found="oops, Hm", clean="x,-"))
    assert [words[w] for w in ("OOPS", "hm", "x", "-", "yes", "?")] == [
        *(PRESENT, PRESENT, ABSENT, ABSENT, PRESENT),
        None,
    ]


def test_a_minus_is_clean_only_beside_a_plus():
    assert ResultWords(["+", "-"], RecordOptions())["-"] == ABSENT
    assert ResultWords(["x", "-"], RecordOptions())["-"] is None
