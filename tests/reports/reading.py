"""Reports as an outside reader sees them, and as their content says."""

import io
import re
import unicodedata

import pypdf

from fieldmon.reports.content import Table

MM = 72 / 25.4
# what steers direction leaves no mark, nor do the dots of Arabic letters, drawn by themselves
_STEERING = re.compile("[\u2066-\u2069\u200e\u200f\x00-\x08]")


def plain(text):
    """Return a text as it is read: without marks of direction, spaces and joined letters alike."""
    return " ".join(unicodedata.normalize("NFKC", _STEERING.sub("", text)).split())


def opened(data):
    return pypdf.PdfReader(io.BytesIO(data))


def texts(data):
    """Return the text of each page."""
    return [plain(page.extract_text()) for page in opened(data).pages]


def sizes_mm(data):
    return [
        tuple(round(float(side) / MM, 1) for side in page.mediabox[2:])
        for page in opened(data).pages
    ]


def one(report, kind, title=None):
    """Return the one block of a kind in a report, or the one of that title."""
    blocks = [block for sheet in report.sheets for block in sheet.blocks]
    (found,) = [
        block for block in blocks
        if isinstance(block, kind) and (title is None or block.title == title)
    ]  # fmt: skip
    return found


def table(report, title):
    return one(report, Table, title)
