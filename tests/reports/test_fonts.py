"""Fonts cut down to what is written."""

import hashlib
import io
import subprocess
import sys

import pytest
from fontTools.ttLib import TTFont

from fieldmon.reports.fonts import FontSet


def letters(data):
    with TTFont(io.BytesIO(data)) as font:
        return {chr(code) for code in font.getBestCmap()}


def test_a_font_holds_the_letters_written_and_hardly_more():
    made = FontSet.of(["abc"])
    assert [(one.family, one.style) for one in made.fonts] == [("open", ""), ("open", "B")]
    for one in made.fonts:
        assert set("abc ?") <= letters(one.data) <= set("abc ?\u00a0")
        assert len(one.data) < 20_000


def test_arabic_letters_bring_their_own_font_with_what_joins_them():
    made = FontSet.of(["Gate", "حقل"])
    (arabic,) = [one for one in made.fonts if (one.family, one.style) == ("arabic", "")]
    assert set("حقل") <= letters(arabic.data)
    with TTFont(io.BytesIO(arabic.data)) as font:
        forms = {one.FeatureTag for one in font["GSUB"].table.FeatureList.FeatureRecord}
    assert {"init", "medi", "fina"} <= forms


def test_the_bold_font_is_wider():
    light, bold = FontSet.of(["hamburg"]).fonts
    widths = []
    for one in (light, bold):
        with TTFont(io.BytesIO(one.data)) as font:
            widths.append(sum(wide for wide, _ in font["hmtx"].metrics.values()))
    assert widths[1] > 1.02 * widths[0]


@pytest.mark.parametrize("text", ["plain", "עברית", "Ωμέγα", "Поле", "Đà Lạt", "–…×°½", "حقل پسته"])
def test_these_scripts_lack_nothing(text):
    assert FontSet.of([text]).missing == frozenset()


def test_what_no_font_has_is_named_and_replaced():
    made = FontSet.of(["a葡b"])
    assert made.missing == {"葡"}
    assert made.printable("a葡b") == "a?b"


def test_marks_of_direction_are_no_letters():
    assert FontSet.of(["\u2068Gate\u2069 \u200f"]).missing == frozenset()


def test_no_line_ends_before_a_percent_sign():
    assert FontSet.of([""]).printable("90 % of 5 plants") == "90\u00a0% of 5 plants"


def test_the_same_letters_are_the_same_bytes_in_every_process():
    code = (
        "import hashlib; from fieldmon.reports.fonts import FontSet\n"
        "made = FontSet.of(['Gate חלקה', 'حقل'])\n"
        "print(hashlib.sha256(b''.join(one.data for one in made.fonts)).hexdigest())"
    )
    other = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True)
    own = b"".join(one.data for one in FontSet.of(["Gate חלקה", "حقل"]).fonts)
    assert other.stdout.decode().strip() == hashlib.sha256(own).hexdigest()
