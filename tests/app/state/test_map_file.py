"""The script that draws maps is what its sources build; its address changes with it."""

import hashlib
import re

from app.state import map_file
from tests.app.bundles import digest_of_sources
from tests.paths import ROOT

FOLDER = ROOT / "app" / "map_view"


def test_its_address_changes_with_the_script():
    digest = hashlib.sha256(map_file.FILE.read_bytes()).hexdigest()
    assert re.fullmatch(r"/map_view/([0-9a-f]{16})\.js", map_file.ADDRESS)[1] == digest[:16]


def test_the_script_is_what_its_sources_build():
    """`cd app/map_view && npm ci && npm run build` writes the digest of what it builds from."""
    first = map_file.FILE.read_text(encoding="utf-8").split("\n", 1)[0]
    said = re.fullmatch(r"// built from ([0-9a-f]{64})", first)
    assert said is not None, first[:80]
    assert said[1] == digest_of_sources(FOLDER), "the sources changed: npm run build"


def test_the_script_asks_nothing_of_the_world():
    """Names of schemas and words in error messages are no requests."""
    text = map_file.FILE.read_text(encoding="utf-8")
    asked = set(re.findall(r"(?:fetch|import)\(\s*[\"'`](https?:[^\"'`]+)", text))
    assert asked == set()


def test_the_licence_of_every_package_in_it_is_handed_out_with_it():
    text = (FOLDER / "LICENSES.txt").read_text(encoding="utf-8")
    assert "@deck.gl/core 9.4.0" in text
    assert text.count("MIT") + text.count("Permission is hereby granted") > 3
