"""HTML pages as a strict reader sees them: what is shown, what is asked for, what would run."""

import re
from html.parser import HTMLParser

VOID = {"meta", "br", "hr", "img", "input", "link"}
#: attributes by which a page fetches or leads to something
ASKING = {"src", "href", "xlink:href", "srcset", "data", "action", "poster", "background"}
#: texts that do harm where they are not escaped
HOSTILE = (
    '<img src="x" onerror=alert(1)>',
    "<script>alert(1)</script>",
    "</title></style></svg><b>out</b>",
    '" onmouseover="alert(1)" \'',
    "&lt;b&gt; {{ 7 * 7 }} {% raw %}",
)


class Page(HTMLParser):
    """A page, parsed; every element must be closed where it should be.

    ``tables`` are lists of rows of the cells' texts; ``text`` is what is read, without the styles.
    """

    def __init__(self, source):
        super().__init__()
        self.source, self.text, self.styles = str(source), "", ""
        self.elements, self.tables, self.headings, self.items, self.open = [], [], [], [], []
        self.feed(self.source)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.handle_startendtag(tag, attrs)
        if tag in VOID:
            return
        self.open.append(tag)
        if tag == "table":
            self.tables.append([])
        elif tag == "tr":
            self.tables[-1].append([])
        elif tag in {"td", "th"}:
            self.tables[-1][-1].append("")
        elif tag in {"h1", "h2"}:
            self.headings.append("")
        elif tag == "li":
            self.items.append("")

    def handle_startendtag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if "style" in self.open:
            self.styles += data
            return
        self.text += data
        inner = self.open[-1] if self.open else ""
        if {"td", "th"} & set(self.open):
            cell = self.tables[-1][-1]
            # what stands below the cell's own value is told apart by a space
            cell[-1] += f" {data}" if inner == "small" and not cell[-1].endswith(" ") else data
        elif {"h1", "h2"} & set(self.open):
            self.headings[-1] += data
        elif inner == "li":
            self.items[-1] += data

    @property
    def tags(self):
        """Return the elements' names, in order."""
        return [tag for tag, _ in self.elements]

    @property
    def attributes(self):
        """Return all attributes with their values, in order."""
        return [pair for _, attrs in self.elements for pair in attrs.items()]

    def all(self, tag, kind=""):
        """Return the attributes of all elements of a name, and of a class where one is given."""
        return [
            attrs for name, attrs in self.elements
            if name == tag and (not kind or kind in attrs.get("class", "").split())
        ]  # fmt: skip

    @property
    def asks_for(self):
        """Return what the page would fetch: nothing, if it is whole."""
        named = [value for name, value in self.attributes if name in ASKING]
        return named + re.findall(r"@import|url\([^)]*\)", self.styles)

    @property
    def runs(self):
        """Return what in the page could be run as a program."""
        handlers = [name for name, _ in self.attributes if name.startswith("on")]
        return handlers + [tag for tag in self.tags if tag in {"script", "iframe", "img", "object"}]


def held(source, hostile=HOSTILE):
    """Return a page after checking that hostile texts stand in it as texts, and do nothing."""
    page = Page(source)
    shown = page.text + " ".join(value or "" for _, value in page.attributes)
    missing = [text for text in hostile if text not in shown]
    assert missing == []
    assert page.runs == page.asks_for == []
    return page
