"""Signs in texts that lead nowhere, format nothing and stay together. No Streamlit in here."""

from __future__ import annotations

import re

# what Markdown formats by, inside a line
_FORMATS = re.compile(r"[\\`*_$\[\]<>~#|&]")
# and what the page makes pictures of by name, escaped or not
_PICTURES = re.compile(r":(?=[a-z+-])", re.IGNORECASE)
# signs that embed, override or isolate a direction, and their ends (Unicode Standard Annex 9)
_TURNING = re.compile("[\u202a-\u202e\u2066-\u2069]")
_LEADING = re.compile(r"\](?=[\[(:])|!(?=\[)|:(?=//)|www(?=\.)|(?<=\S)@(?=\S)", re.IGNORECASE)
# what stands after a number, and not on the next line
_UNIT = re.compile(r"(?<=\d) (?=%|(?:h|m|km|ha|ft|mi|l|°C)\b)")


def together(text: str) -> str:
    """Return a text in which no line ends between a number and its sign or unit."""
    return _UNIT.sub("\u00a0", text)


def leading_nowhere(text: str, *, turning: bool = True) -> str:
    """Return a text of a file in which nothing becomes a link or a picture of the internet.

    What Markdown or a browser would take for one is parted by a sign that nobody sees. Unless
    `turning`, signs that turn the direction are left out.
    """
    text = text if turning else _TURNING.sub("", text)
    return _LEADING.sub("\\g<0>\u2060", text)


def unformatted(text: str) -> str:
    r"""Return a text as Markdown that shows each of its signs.

    Examples
    --------
    >>> print(unformatted("*webs* at $5"))
    \*webs\* at \$5
    """
    return _FORMATS.sub(r"\\\g<0>", _PICTURES.sub("\\g<0>\u2060", text))


def marked_as_english(sentence: str) -> str:
    """Return an English sentence among others, marked as such and kept from the left."""
    return f"\u2066{sentence}\u2069 [English]"
