"""The texts of the scout's page in a language, as its script asks for them.

No Streamlit in here.
"""

from __future__ import annotations

import json
from contextvars import copy_context

from . import language, texts


def page_words(name: str) -> bytes:
    """Return the page's texts in a language, JSON."""
    return copy_context().run(_spoken, name)


def _spoken(name: str) -> bytes:
    language.use(name)
    said = {key: str(text) for key, text in texts.SCOUT_PAGE.items()}
    return json.dumps(said, ensure_ascii=False).encode()
