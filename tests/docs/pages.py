"""The pages, and what stands in them."""

import re

from tests.paths import ROOT

DOCS = ROOT / "docs"
WRITTEN = [page for page in DOCS.rglob("*.md") if not {"_build", "generated"} & {*page.parts}]
AT_ROOT = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
PAGES = {
    str(page.relative_to(ROOT)): page.read_text(encoding="utf-8") for page in [*AT_ROOT, *WRITTEN]
}
README = PAGES["README.md"]

INLINE = re.compile(r"`([^`\n]+)`")
_FENCE = re.compile(r"^```(\S*)[^\n]*\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def fences(text, *languages):
    """Return the blocks of a page in one of the languages."""
    return [block for language, block in _FENCE.findall(text) if language in languages]


def the_fence(text, language, holds):
    """Return the one block in a language that holds certain words."""
    (block,) = [block for block in fences(text, language) if holds in block]
    return block


def prose(text):
    """Return a page without its blocks."""
    return _FENCE.sub("", text)
