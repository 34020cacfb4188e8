"""Languages: every text has its words in each, with the same blanks; the app speaks them."""

import gettext
import os
import re
import shutil
import string
from functools import cache
from io import BytesIO
from pathlib import Path

import pytest
from babel.messages.pofile import read_po

import fieldmon
from app.state import chosen_language
from app.words import catalogues, language, texts, translations
from tests.app.driving import PAGES, go, map_of, opened, texts_of
from tests.app.test_hostile_texts import EVERY, harm_shown, hostile_season
from tests.app.words.known_texts import catalogue, entries

OTHERS = tuple(code for code in language.LANGUAGES if code != language.ENGLISH)
#: what passes by the catalogues does so in every language: the suite hears one of them
SPOKEN = OTHERS if os.environ.get("FIELDMON_LANGUAGES") == "all" else ("he",)
#: words that are the same in English and Spanish, and names of programs
SAME_WORDS = {
    "Robot", "No", "m", "km", "ft", "mi", "ha", "dunam", "acre", "QGIS", "QField", "ArcGIS",
    "GPS", "GeoTIFF", "GeoJSON", "GeoPackage", "KML", "HTML", "CSV", "PDF", "NDVI", "Nav2", "ROS",
    "Google", "Earth", "shapefile", "zip", "Excel", "lon", "lat", "found", "fieldmon", "h", "s",
}  # fmt: skip


def blanks(words):
    """Return what is filled into a text, and how it is written: no words chosen by a number."""
    return {
        (field, form, how)
        for _, field, form, how in string.Formatter().parse(words)
        if field and "|" not in (form or "")
    }


def strings(held, entry):
    """Return the words of an entry in a catalogue, all its forms; none where it has no entry."""
    found = held.get(entry.id, entry.context)
    if found is None:
        return ()
    return found.string if isinstance(found.string, tuple) else (found.string,)


@pytest.mark.parametrize("code", OTHERS)
def test_every_text_is_translated_and_no_catalogue_holds_more(code):
    held = catalogue(code)
    missing = [e for e in entries() if not all(strings(held, e) or ("",))]
    assert missing == []
    known = {(entry.context, entry.words) for entry in entries()}
    kept = {(m.context, m.id[-1] if isinstance(m.id, tuple) else m.id) for m in held if m.id}
    assert kept - known == set()


@pytest.mark.parametrize("code", OTHERS)
def test_translations_have_the_blanks_of_the_english(code):
    held = catalogue(code)
    for entry in entries():
        for words in strings(held, entry):
            less = blanks(entry.words) - blanks(words)
            # "one plant" and "two plants" are words in some languages, not numbers
            counts = {
                one
                for one in less
                if entry.one and (one[0] in {"n", "inspected"} or one not in blanks(entry.one))
            }
            assert blanks(words) <= blanks(entry.words) | blanks(entry.one), (entry, words)
            assert less == counts, (entry, words)


@pytest.mark.parametrize("code", OTHERS)
def test_translations_keep_the_signs_of_the_page(code):
    held = catalogue(code)
    for entry in entries():
        for words in strings(held, entry):
            for sign in ("**", "### ", "\n"):
                assert words.count(sign) == entry.words.count(sign), (entry, words)


@pytest.mark.parametrize("code", OTHERS)
def test_a_plural_has_as_many_forms_as_the_language_tells_apart(code):
    held = catalogue(code)
    some = gettext.c2py(held.plural_expr)
    assert {some(n) for n in range(201)} == set(range(held.num_plurals))
    for entry in entries():
        if entry.one:
            assert len(strings(held, entry)) == held.num_plurals, entry


def test_in_arabic_what_is_counted_from_11_to_99_has_its_own_ending():
    held = catalogue("ar")
    some, tanwin = gettext.c2py(held.plural_expr), re.compile(r"{n[^}]*} \w+(ًا|اً)")
    ended = [
        (forms[some(14)], forms[some(100)])
        for forms in (strings(held, entry) for entry in entries() if entry.one)
        if any(tanwin.search(form) for form in forms)
    ]
    assert len(ended) > 15
    for of_14, of_100 in ended:
        assert tanwin.search(of_14)
        assert not tanwin.search(of_100)


def says_who_made_it(held):
    """Return whether a catalogue says so, and of a machine at its head too."""
    by = held.last_translator
    return bool(by) and ("machine" in by) == ("MADE BY A MACHINE" in held.header_comment)


@pytest.mark.parametrize("code", OTHERS)
def test_a_catalogue_says_who_made_it_and_holds_the_words_of_the_field(code):
    held = catalogue(code)
    assert says_who_made_it(held)
    assert "hot spot = " in held.header_comment


@pytest.mark.parametrize("code", OTHERS)
def test_who_corrects_a_catalogue_takes_out_a_paragraph_and_says_so(code):
    read = BytesIO(catalogues.path_of(code).read_bytes())
    held = read_po(read, locale=code)
    head = held.header_comment
    paragraph = head[head.index("#\n# MADE BY") : head.index("# This file is all")]
    assert "MACHINE_MADE" in paragraph
    assert "Last-Translator" in paragraph
    held.header_comment = head.replace(paragraph, "")
    assert not says_who_made_it(held)
    held.last_translator = "Ana Ruiz, agronomist"
    assert says_who_made_it(held)


def test_a_draft_is_spoken_by_its_address_with_english_where_it_has_no_words(
    tmp_path, monkeypatch, speaking
):
    lines = catalogues.path_of("es").read_text(encoding="utf-8").split("\n\n", maxsplit=1)[0]
    texts_ = (("LANGUAGE", "Language", "Sprache"), ("DISPLAY", texts.DISPLAY, ""))
    more = [f'msgctxt "{key}"\nmsgid "{said}"\nmsgstr "{new}"\n' for key, said, new in texts_]
    for code in OTHERS:
        shutil.copy(catalogues.path_of(code), tmp_path)
    (tmp_path / "de.po").write_text("\n".join([lines, "", *more]), encoding="utf-8")
    monkeypatch.setattr(translations, "FOLDER", tmp_path)
    assert not language.is_spoken("de")
    monkeypatch.setattr(language, "DRAFTS", {"de": "Deutsch"})
    app = opened(texts.UPLOAD, lang="de")
    speaking("de")
    box = app.selectbox(key=chosen_language.KEY)
    assert not app.exception
    assert (box.label, box.value, box.options[-1]) == ("Sprache", "de", "Deutsch")
    assert texts.DRAFT in [one.value for one in app.caption]
    assert texts.CHANGED_TREATED.format(n=1, day="x") == "1 plant was treated on x."
    assert "Deutsch" not in opened(texts.UPLOAD).selectbox(key=chosen_language.KEY).options


# -- the library's sentences


def test_the_library_knows_nothing_of_languages():
    for path in Path(fieldmon.__file__).parent.rglob("*.py"):
        assert "gettext" not in path.read_text(encoding="utf-8"), path


# -- the app


@pytest.mark.parametrize("code", SPOKEN)
def test_pages_speak_the_language_of_the_address(code, speaking):
    speaking(code)  # the harness asks boxes for the names of what they hold
    app = opened(lang=code)
    for part in ("today", "plot"):  # the others are the same in a season: see below
        go(app, part)
        assert not app.exception, part
        assert not app.error, part
        assert english_left(app, code) == [], part


def test_every_page_speaks_another_language_and_shows_what_does_harm_as_text(
    seasons_folder, speaking
):
    """In a season whose every text field is full of it."""
    hostile_season(seasons_folder / "Harm.gpkg", f"{EVERY} {'x' * 10_000}")
    left = {}
    for code in SPOKEN:
        speaking(code)  # see above
        app, shown = opened("Harm", lang=code), 0
        for part in PAGES:
            go(app, part)
            assert not app.exception, (code, part)
            assert not app.error, (code, part)
            left[code, part] = english_left(app, code)
            shown += harm_shown(app)
        assert shown >= 3
    assert {where: lines for where, lines in left.items() if lines} == {}


def said(app):
    """Return everything that a page says: texts, boxes and what they offer, tables, the map."""
    lines = texts_of(app).splitlines()
    for one in (*app.main, *app.sidebar):
        proto = getattr(one, "proto", None)
        lines += [str(getattr(proto, name, "")) for name in ("label", "help", "placeholder")]
        lines += [getattr(option, "content", option) for option in getattr(proto, "options", ())]
    for table in (*app.dataframe, *app.table):
        lines += [str(name) for name in (*table.value.columns, table.value.index.name or "")]
    return [line for line in (*lines, *on_map(app)) if line]


def on_map(app):
    """Return what is written on the map."""
    data = map_of(app)
    parts = (*data["switches"], *data["shades"], *data["labels"])
    lines = [str(one.get("label", one.get("text", ""))) for one in parts]
    for part in data["legend"]:
        lines += [str(part.get("title", "")), *(str(item[-1]) for item in part["items"])]
    return [data["alt"], *lines]


def english_left(app, code):
    """Return our own English texts on a page, and lines with three of our English words."""
    english, ours = only_english(code)
    lines = [line for line in said(app) if "[English]" not in line]
    whole = [line for line in lines if line in english]
    plain = [re.sub(r"\u2068.*?\u2069|\u2066.*?\u2069", "", line) for line in lines]
    return whole + [
        line for line in plain
        if any(all(w.lower() in ours for w in run.split()) and not spanish(run)
               for run in re.findall(r"(?:\b[A-Za-z]{2,}\b[ ]){2}\b[A-Za-z]{2,}\b", line))
    ]  # fmt: skip


@cache
def only_english(code):
    """Return our English texts that this language says otherwise, and the words of all of ours."""
    held = catalogue(code)
    english = {entry.words for entry in entries() if entry.words not in strings(held, entry)}
    english -= {words for entry in entries() for words in strings(held, entry)}
    ours = {w.lower() for e in entries() for w in re.findall(r"[A-Za-z]{2,}", e.words)}
    return english, ours - {word.lower() for word in SAME_WORDS}


def spanish(words):
    """Return whether all of these words are also Spanish ones of ours."""
    return all(word.lower() in spanish_words() for word in words.split())


@cache
def spanish_words():
    held = catalogue("es")
    return {
        word.lower() for entry in entries() for text in strings(held, entry)
        for word in re.findall(r"[A-Za-z]{2,}", text)
    }  # fmt: skip
