"""What there is to translate, and the files that hold it."""

from app.words import catalogues
from tests.app.words.known_texts import entries

OTHERS = ("he", "ar", "es")


def test_catalogues_are_as_the_command_writes_them(tmp_path, monkeypatch):
    known = list(entries())
    monkeypatch.setattr(catalogues, "entries", lambda: known)
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
    known, new = entries(), catalogues.TextEntry("NEW", "A new text")
    monkeypatch.setattr(catalogues, "entries", lambda: [*known, new])
    assert catalogues.update("he") == [new]
    assert catalogues.read("he").get(new.id, new.context).string == ""
