"""Languages: every text has its words in each, with the same blanks; the app speaks them."""

import gettext
import re
import string
from pathlib import Path

import pytest

import fieldmon
from app.state import chosen_language
from app.words import catalogues, language, texts
from app.words.units import Units
from fieldmon.compute.wording import Worded, counted, joined, worded
from fieldmon.io.writers import FORMATS
from tests.app.driving import go, map_of, opened, texts_of

OTHERS = tuple(code for code in language.LANGUAGES if code != language.ENGLISH)
ENTRIES = catalogues.entries()
#: words that are the same in English and Spanish, and names of programs
SAME_WORDS = {
    "Robot", "No", "m", "km", "ft", "mi", "ha", "dunam", "acre", "QGIS", "QField", "ArcGIS", "GPS",
    "GeoTIFF", "GeoJSON", "GeoPackage", "KML", "HTML", "CSV", "PDF", "NDVI", "Nav2", "ROS", "Google",
    "Earth", "shapefile", "zip", "Excel", "lon", "lat", "found", "fieldmon", "h", "s",
}  # fmt: skip


@pytest.fixture
def speaking():
    """Let the texts speak a language, and English again at the end."""

    def speak(code):
        language.use(code)

    yield speak
    language.use(language.ENGLISH)


def blanks(words):
    """Return what is filled into a text, and how it is written."""
    return {
        (field, form, how) for _, field, form, how in string.Formatter().parse(words) if field
    }  # fmt: skip


def strings(catalogue, entry):
    """Return the words of an entry in a catalogue, all its forms; none where it has no entry."""
    found = catalogue.get(entry.id, entry.context)
    if found is None:
        return ()
    return found.string if isinstance(found.string, tuple) else (found.string,)


@pytest.mark.parametrize("code", OTHERS)
def test_every_text_is_translated_and_no_catalogue_holds_more(code):
    catalogue = catalogues.read(code)
    missing = [e for e in ENTRIES if not all(strings(catalogue, e) or ("",))]
    assert missing == []
    known = {(entry.context, entry.words) for entry in ENTRIES}
    held = {(m.context, m.id[-1] if isinstance(m.id, tuple) else m.id) for m in catalogue if m.id}
    assert held - known == set()


@pytest.mark.parametrize("code", OTHERS)
def test_translations_have_the_blanks_of_the_english(code):
    catalogue = catalogues.read(code)
    for entry in ENTRIES:
        for words in strings(catalogue, entry):
            less = blanks(entry.words) - blanks(words)
            # "one plant" and "two plants" are words in some languages, not numbers
            counts = {one for one in less if entry.one and one[0] in {"n", "inspected"}}
            assert blanks(words) <= blanks(entry.words) | blanks(entry.one), (entry, words)
            assert less == counts, (entry, words)


@pytest.mark.parametrize("code", OTHERS)
def test_translations_keep_the_signs_of_the_page(code):
    catalogue = catalogues.read(code)
    for entry in ENTRIES:
        for words in strings(catalogue, entry):
            for sign in ("**", "### ", "\n"):
                assert words.count(sign) == entry.words.count(sign), (entry, words)


@pytest.mark.parametrize("code", OTHERS)
def test_a_plural_has_as_many_forms_as_the_language_tells_apart(code):
    catalogue = catalogues.read(code)
    some = gettext.c2py(catalogue.plural_expr)
    assert {some(n) for n in range(201)} == set(range(catalogue.num_plurals))
    for entry in ENTRIES:
        if entry.one:
            assert len(strings(catalogue, entry)) == catalogue.num_plurals, entry


@pytest.mark.parametrize("code", OTHERS)
def test_a_catalogue_says_who_made_it_and_holds_the_words_of_the_field(code):
    head = catalogues.read(code).header_comment
    assert "MADE BY A MACHINE" in head
    assert "hot spot = " in head


def test_catalogues_are_as_the_command_writes_them(tmp_path, monkeypatch):
    before = {code: catalogues.path_of(code).read_bytes() for code in OTHERS}
    for code, data in before.items():
        (tmp_path / f"{code}.po").write_bytes(data)
    monkeypatch.setattr(catalogues, "FOLDER", tmp_path)
    for code in OTHERS:
        assert catalogues.update(code) == []
        assert (tmp_path / f"{code}.po").read_bytes() == before[code]


def test_a_new_text_waits_for_its_translation(tmp_path, monkeypatch):
    (tmp_path / "he.po").write_bytes(catalogues.path_of("he").read_bytes())
    monkeypatch.setattr(catalogues, "FOLDER", tmp_path)
    new = catalogues.Entry("NEW", "A new text")
    monkeypatch.setattr(catalogues, "entries", lambda: [*ENTRIES, new])
    assert catalogues.update("he") == [new]
    assert strings(catalogues.read("he"), new) == ("",)


# -- texts


def test_a_text_is_read_in_the_language_that_is_spoken(speaking):
    assert texts.ROOMS["today"] == "Today"
    speaking("he")
    assert texts.ROOMS["today"] == "היום"
    assert texts.COMPASS[0] == "צפונה"
    assert texts.TITLE == "fieldmon"


def test_a_count_takes_the_form_that_the_language_asks_for(speaking):
    assert [texts.PLOTS_TITLE.format(n=n) for n in (1, 2)] == ["1 plot", "2 plots"]
    speaking("ar")
    said = [texts.PLOTS_TITLE.format(n=n) for n in (1, 2, 5, 12, 100)]
    assert said == ["قطعة واحدة", "قطعتان", "5 قطع", "12 قطعة", "100 قطعة"]


def test_numbers_in_a_text_are_written_as_in_the_language(speaking):
    assert texts.CHANCE_P.format(n=12_345) == "about 1 in 12,345"
    speaking("es")
    assert texts.CHANCE_P.format(n=12_345) == "alrededor de 1 entre 12.345"
    assert Units().metres(1234.5) == "1,23 km"
    assert language.number(0.125, ".1%") == "12,5%"


def test_who_reads_a_format_is_said_as_the_library_says_it():
    assert texts.READERS == {name: one.reader for name, one in FORMATS.items()}


# -- the library's sentences


def test_a_worded_sentence_is_the_sentence_everywhere_but_remembers_its_words():
    said = worded("{plants} {where}: never inspected yet.", plants=counted(3, "plant"),
                  where=worded("in row {row}", row=7))  # fmt: skip
    assert said == "3 plants in row 7: never inspected yet."
    assert f"{said}" == str(said) == said
    assert isinstance(said, Worded)


def test_a_worded_sentence_of_the_library_is_said_in_the_language(speaking):
    said = worded("{plants} {where}: never inspected yet.", plants=counted(1, "plant"),
                  where=worded("in row {row}", row=7))  # fmt: skip
    speaking("he")
    assert language.in_words(said) == "צמח אחד בשורה 7: עדיין לא נבדקו מעולם."
    assert language.in_words(joined("; ", [said, said])).count("צמח אחד") == 2


def test_a_sentence_that_nobody_translated_stays_english_and_says_so(speaking):
    assert language.in_words("Something.") == "Something."
    speaking("he")
    assert language.in_words("Something.") == "\u2066Something.\u2069 [English]"
    assert language.in_words(worded("Nobody knows {n}.", n=3)) == (
        "\u2066Nobody knows 3.\u2069 [English]"
    )


def test_worded_sentences_survive_the_way_from_another_process():
    import pickle

    said = pickle.loads(pickle.dumps(worded("in row {row}", row=counted(2, "plant"))))
    assert (said, said.words, said.values["row"].one) == (
        "in row 2 plants",
        "in row {row}",
        "{n} plant",
    )


def test_the_library_knows_nothing_of_languages():
    for path in Path(fieldmon.__file__).parent.rglob("*.py"):
        assert "gettext" not in path.read_text(encoding="utf-8"), path


# -- the app


@pytest.mark.parametrize("code", OTHERS)
@pytest.mark.parametrize("part", ["today", "season", "compare", "plot"])
def test_pages_speak_the_language_of_the_address(code, part):
    app = opened(lang=code)
    go(app, part)
    assert not app.exception
    assert not app.error
    left = english_left(app, code)
    assert left == []


@pytest.mark.parametrize("code", OTHERS)
def test_a_season_speaks_the_language(season_app, code):
    season_app.session_state[chosen_language.KEY] = code
    season_app.run()
    for part in ("today", "season", "plot"):
        go(season_app, part)
        assert not season_app.exception
        assert english_left(season_app, code) == []


def said(app):
    """Return everything that a page says: texts, names of boxes and buttons, what they offer."""
    kinds = ("button", "selectbox", "number_input", "metric", "tabs", "expander", "toggle",
             "text_input", "date_input", "slider", "download_button", "button_group")  # fmt: skip
    lines = texts_of(app).splitlines()
    for kind in kinds:
        for one in app.get(kind):
            lines.append(str(getattr(one, "label", "") or ""))
            lines += [str(option) for option in getattr(one, "options", ())]
    return lines


def english_left(app, code):
    """Return our own English texts on a page, and lines with three of our English words."""
    catalogue = catalogues.read(code)
    english = {
        entry.words for entry in ENTRIES if entry.words not in strings(catalogue, entry)
    } - {w for entry in ENTRIES for w in strings(catalogue, entry)}  # fmt: skip
    lines = [line for line in said(app) if "[English]" not in line]
    whole = [line for line in lines if line in english]
    plain = [re.sub(r"\u2068.*?\u2069|\u2066.*?\u2069", "", line) for line in lines]
    ours = {w.lower() for e in ENTRIES for w in re.findall(r"[A-Za-z]{2,}", e.words)}
    ours -= {word.lower() for word in SAME_WORDS}
    return whole + [
        line for line in plain
        if any(all(w.lower() in ours for w in run.split()) and not spanish(run)
               for run in re.findall(r"(?:\b[A-Za-z]{2,}\b[ ]){2}\b[A-Za-z]{2,}\b", line))
    ]  # fmt: skip


def spanish(words):
    """Return whether all of these words are also Spanish ones of ours."""
    return all(word.lower() in SPANISH for word in words.split())


SPANISH = {
    word.lower() for entry in ENTRIES for text in strings(catalogues.read("es"), entry)
    for word in re.findall(r"[A-Za-z]{2,}", text)
}  # fmt: skip


def test_the_language_is_chosen_in_its_box_and_kept_in_the_address():
    app = opened()
    app.selectbox(key=chosen_language.KEY).set_value("he").run()
    assert not app.exception
    assert "משק לדוגמה" in app.selectbox(key="season").options
    assert app.query_params["lang"] == ["he"]
    sent = map_of(app)
    assert (sent["language"], sent["direction"]) == ("he", "rtl")
    assert app.selectbox(key="date_like").value == "16.11.2026"
    app.selectbox(key=chosen_language.KEY).set_value("en").run()
    assert "lang" not in app.query_params
    assert app.selectbox(key="date_like").value == "2026-11-16"
    assert map_of(app)["direction"] == "ltr"


def test_an_address_in_a_language_nobody_speaks_is_english():
    app = opened(lang="xx")
    assert not app.exception
    assert "Plan" in texts_of(app) or app.selectbox(key=chosen_language.KEY).value == "en"


def test_two_sessions_speak_two_languages():
    first, second = opened(lang="he"), opened(lang="es")
    first.run()
    second.run()
    assert "משק לדוגמה" in first.selectbox(key="season").options
    assert "Finca de muestra" in second.selectbox(key="season").options
