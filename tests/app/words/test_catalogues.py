"""What there is to translate, and the files that hold it."""

import ast
import re
import shutil
from pathlib import Path

import pytest

import fieldmon
from app.words import catalogues, translations
from app.words.language import LIBRARY
from fieldmon import errors
from tests.app.words.known_texts import catalogue, entries

OTHERS = ("he", "ar", "es")


def test_catalogues_are_as_the_command_writes_them(tmp_path, monkeypatch):
    known = list(entries())
    monkeypatch.setattr(catalogues, "entries", lambda: known)
    before = {code: catalogues.path_of(code).read_bytes() for code in OTHERS}
    for code, data in before.items():
        (tmp_path / f"{code}.po").write_bytes(data)
    monkeypatch.setattr(catalogues, "FOLDER", tmp_path)
    for code in OTHERS:
        open_ = catalogues.update(code)
        assert open_ == [], f"Run python -m app.words.catalogues, and translate in {code}.po."
        same = (tmp_path / f"{code}.po").read_bytes() == before[code]
        assert same, "Run python -m app.words.catalogues, and commit what it writes."


@pytest.mark.parametrize("code", OTHERS)
def test_every_share_of_a_language_has_its_sign_in_one_way(code):
    other = r"[\d}]%" if code == "es" else r"[\d}]\s%"
    said = [each.string for each in catalogue(code) if each.id]
    forms = [form for one in said for form in (one if isinstance(one, tuple) else (one,))]
    assert [form for form in forms if re.search(other, re.sub(r":[^{}]*%}", "}", form))] == []


#: a text of the app, told by its place, and a sentence of the library, told by its words
OWN, OF_LIBRARY = "Take back: {answer}", "turning radius"


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """Write a file with some of the Hebrew texts, once; return it and what it holds."""
    all_of, some = list(entries()), tmp_path_factory.mktemp("small")
    held = [one for k, one in enumerate(all_of) if not k % 60 or one.words in (OWN, OF_LIBRARY)]
    (some / "he.po").write_bytes(catalogues.path_of("he").read_bytes())
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(catalogues, "FOLDER", some)
        patch.setattr(catalogues, "entries", lambda: held)
        assert catalogues.update("he") == []
    return some / "he.po", held


@pytest.fixture
def he(small, tmp_path, monkeypatch):
    """Return a copy of that file, in the folder that the command writes to."""
    monkeypatch.setattr(catalogues, "FOLDER", tmp_path)
    monkeypatch.setattr(translations, "FOLDER", tmp_path)
    return Path(shutil.copy(small[0], tmp_path))


@pytest.mark.usefixtures("he")
def test_a_new_text_waits_for_its_translation(small, monkeypatch):
    _, known = small
    new = catalogues.TextEntry("NEW", "A new text")
    monkeypatch.setattr(catalogues, "entries", lambda: [*known, new])
    assert catalogues.update("he") == [new]
    assert catalogues.read("he").get(new.id, new.context).string == ""


def lines_of(path, words):
    """Return the lines of a file's entry of these English words."""
    blocks = path.read_text().split("\n\n")
    return next(block.split("\n") for block in blocks if f'msgid "{words}"' in block.split("\n"))


def test_a_text_whose_english_changed_keeps_its_translation_until_somebody_looked_at_it(
    he, small, monkeypatch
):
    _, known = small
    news = {OWN: "Take it back: {answer}", OF_LIBRARY: "turning radius of it"}
    before = catalogues.read("he")
    own = {old: next(entry for entry in known if entry.words == old) for old in news}
    kept = {old: before.get(old, entry.context).string for old, entry in own.items()}
    lines = {old: lines_of(he, old) for old in news}
    changed = {old: catalogues.TextEntry(own[old].context, new) for old, new in news.items()}
    instead = {own[old]: entry for old, entry in changed.items()}
    wanted = [instead.get(entry, entry) for entry in known]
    monkeypatch.setattr(catalogues, "entries", lambda: wanted)
    open_ = catalogues.update("he")
    assert {*open_} == {*changed.values()}
    assert catalogues.update("he") == open_  # as often as it is run
    spoken = translations.catalogue_of.__wrapped__("he")
    text = he.read_text()
    for old, new in news.items():
        written = lines_of(he, new)
        assert written[0].startswith("#, fuzzy")
        assert written[1] == f'#| msgid "{old}"'
        assert lines[old][-1] == written[-1] == f'msgstr "{kept[old]}"'
        assert spoken.pgettext(own[old].context, new) == ""
        # whoever looked at it takes the marks out
        mark = "#, python-brace-format\n" if "{" in new else ""
        text = text.replace("\n".join(written[:2]) + "\n", mark)
    he.write_text(text)
    assert catalogues.update("he") == []
    assert he.read_text() == text
    spoken = translations.catalogue_of.__wrapped__("he")
    for old, new in news.items():
        assert spoken.pgettext(own[old].context, new) == kept[old]


def test_what_was_long_and_counted_is_kept_whole(he, monkeypatch):
    one, many = "{n} " + "very long word " * 9, "{n} " + "very long words " * 9
    monkeypatch.setattr(catalogues, "entries", lambda: [catalogues.TextEntry("P", many, one)])
    catalogues.update("he")
    he.write_text(he.read_text().replace('msgstr[0] ""', 'msgstr[0] "x"'))
    changed = catalogues.TextEntry("P", f"{many}!", one)
    monkeypatch.setattr(catalogues, "entries", lambda: [changed])
    assert catalogues.update("he") == [changed]
    first = he.read_text()
    said = "".join(re.findall(r'^#\| (?:msgid\w* )?"(.*)"$', first, re.MULTILINE))
    assert said == one + many
    assert catalogues.update("he") == [changed]
    assert he.read_text() == first
    assert catalogues.read("he").get(changed.id, "P").string[0] == "x"


@pytest.mark.usefixtures("he")
def test_texts_stay_where_they_are_and_new_ones_come_behind_what_they_stand_behind(monkeypatch):
    def written(*words):
        made = [catalogues.TextEntry(LIBRARY, one) for one in words]
        monkeypatch.setattr(catalogues, "entries", lambda: made)
        catalogues.update("he")
        return [message.id for message in catalogues.read("he") if message.id]

    assert written() == []
    assert written("apples", "plums", "cherries") == ["apples", "plums", "cherries"]
    # a new module says two of them, too, and something of its own
    assert written("new", "cherries", "quinces", "apples", "plums") == [
        "new", "apples", "plums", "cherries", "quinces",
    ]  # fmt: skip
    assert written("new", "cherries", "apples") == ["new", "apples", "cherries"]


#: whose sentences only commands, studies and programs meet, not somebody at a page
_ELSEWHERE = {
    "cli", "compute", "drive", "samplers", "simulation", "studies",
    "decisions/leaves.py", "decisions/taylor.py", "infestation/belief.py",
    "infestation/hotspots.py", "infestation/inspections.py", "infestation/insects/kernels.py",
    "infestation/records.py", "infestation/insects/spread.py", "monitoring/estimates/asked_day.py",
    "monitoring/estimates/monitor.py", "planning/routes", "plot/frames.py",
    "plot/order_in_frame.py", "plot/positions.py",
}  # fmt: skip
_SAYS = {"seen", "repaired", "guessed", "dropped", "doubtful", "ask_for_crs"}
_LABEL = {"Remedy": 2, "ask_for_crs": 2}


def _unworded(path):
    """Yield what a module says to a person in words that no catalogue can know."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if not isinstance(node, ast.Call) or not node.args:
            continue
        name = getattr(node.func, "attr", None) or getattr(node.func, "id", "")
        is_problem = isinstance(getattr(errors, name, None), type)
        place = _LABEL.get(name, 0)
        if (is_problem or name in _SAYS or name in _LABEL) and len(node.args) > place:
            said = node.args[place]
            plain = isinstance(said, ast.Constant) and isinstance(said.value, str)
            if isinstance(said, ast.JoinedStr) or plain:
                yield f"{path.name}:{node.lineno}: {ast.unparse(said)[:80]}"


def test_what_somebody_at_a_page_may_be_told_is_worded_and_so_translated():
    folder = Path(fieldmon.__file__).parent
    paths = [path for path in sorted(folder.rglob("*.py")) if "_app" not in path.parts]
    for path in paths:
        place = path.relative_to(folder).as_posix()
        if not any(place == one or place.startswith(f"{one}/") for one in _ELSEWHERE):
            assert [*_unworded(path)] == []


def test_a_plain_sentence_is_noticed(tmp_path):
    module = tmp_path / "module.py"
    module.write_text(
        "raise SettingError(f'It is {it}.')\nmessage = dropped('Left out.')\n"
        "raise FileProblem(worded('It is {it}.', it=it))\n"
    )
    assert [line.partition(":")[2][:1] for line in _unworded(module)] == ["1", "2"]


@pytest.mark.parametrize("code", OTHERS)
def test_different_things_are_counted_in_different_words(code):
    held, same = catalogue(code), {"{n:,} stations", "{n:,} pieces"}  # as stops and plots in some
    counted = [e for e in entries() if e.one and e.context == LIBRARY and e.words not in same]
    assert len(counted) > 10
    assert len({held.get(e.id, e.context).string for e in counted}) == len(counted)
