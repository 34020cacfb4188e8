"""The scout's page is what its sources build, and knows all that it needs without a network."""

import json
import re
from urllib.parse import parse_qs, urlsplit

import pytest

from app.state import scout_page
from app.state.scout_page import FOLDER, PATH, files, invitation
from app.words.language import LANGUAGES
from tests.app.bundles import digest_of_sources
from tests.paths import ROOT

SOURCES = ROOT / "app" / "scout_page"


@pytest.mark.parametrize("name", ["scout.js", "worker.js"])
def test_the_scripts_are_what_their_sources_build(name):
    """`cd app/scout_page && npm ci && npm run build` writes the digest of what it builds from."""
    first = (FOLDER / name).read_text(encoding="utf-8").split("\n", 1)[0]
    assert first == f"// built from {digest_of_sources(SOURCES)}", (
        "the sources changed: npm run build"
    )


@pytest.mark.parametrize(
    ("source", "made"),
    [
        ("page.html", "page.html"),
        ("manifest.json", "manifest.webmanifest"),
        ("icon.svg", "icon.svg"),
    ],
)
def test_what_is_handed_out_as_it_is_is_the_same(source, made):
    assert (SOURCES / "src" / source).read_bytes() == (FOLDER / made).read_bytes()


def test_what_works_offline_knows_every_file():
    worker = files()[f"{PATH}worker.js"].data.decode()
    listed = re.search(r'"([^"]+ \./ [^"]+)"\.split', worker)[1].split()
    there = {name.removeprefix(PATH) or "./" for name in files()} - {"worker.js"}
    assert set(listed) == there
    assert {f"words/{name}.json" for name in LANGUAGES} < there
    page = files()[PATH].data.decode()
    assert set(re.findall(r'(?:href|src)="([^"]+)"', page)) <= there
    manifest = json.loads(files()[f"{PATH}manifest.webmanifest"].data)
    assert {icon["src"] for icon in manifest["icons"]} <= there
    assert manifest["start_url"] == manifest["scope"] == PATH


def test_it_is_another_version_when_a_word_changes(monkeypatch):
    before = files()[f"{PATH}worker.js"].data
    monkeypatch.setattr(scout_page.scout_words, "page_words", lambda name: name.encode())
    files.cache_clear()
    try:
        assert files()[f"{PATH}worker.js"].data != before
    finally:
        files.cache_clear()


def test_every_word_that_the_page_says_is_there_and_none_is_idle():
    script = "\n".join(p.read_text(encoding="utf-8") for p in (SOURCES / "src").glob("*.js"))
    known = set(json.loads(files()[f"{PATH}words/en.json"].data))
    assert set(re.findall(r'[^#]say\("(\w+)"', script)) - known == set()
    # others are named by a stage or a state, or handed on
    built = {name for name in known if name.startswith(("stage_", "state_"))}
    assert {name for name in known - built if f'"{name}"' not in script} == set()


def test_the_page_asks_nothing_of_the_world():
    for name in ("scout.js", "worker.js", "scout.css", "page.html"):
        text = (FOLDER / name).read_text(encoding="utf-8")
        assert re.findall(r"https?://[^\s\"'`)]+", text) == []
    assert "default-src 'none'" in scout_page.POLICY


def test_the_licence_of_what_is_in_it_is_handed_out_with_it():
    text = (SOURCES / "LICENSES.txt").read_text(encoding="utf-8")
    assert "idb 8.0.4" in text
    assert "Jake Archibald" in text


def test_an_invitation_holds_the_key_where_browsers_send_it_to_nobody():
    address = invitation("https://192.168.1.5:8501/", "מטע & 1", "a+b", "2026-11-16", "he")
    parts = urlsplit(address)
    assert (parts.path, parts.query) == ("/scouting/", "")
    assert parse_qs(parts.fragment) == {
        "season": ["מטע & 1"], "key": ["a+b"], "on": ["2026-11-16"], "lang": ["he"]
    }  # fmt: skip
