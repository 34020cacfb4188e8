"""Drawings on a page of PDF: as outside programs draw and read them."""

import io
from datetime import date

import numpy as np
import pytest
from fpdf import FPDF
from PIL import Image

from fieldmon.reports.content import Illustration, Report, Sheet
from fieldmon.reports.drawing import (
    Areas,
    Bitmap,
    Discs,
    Drawing,
    Lettering,
    Segments,
    Strokes,
)
from fieldmon.reports.pdf import pdf_bytes
from fieldmon.reports.pdf_painter import wide_mm
from tests.reports.reading import MM, opened, texts

RED, BLUE = (213, 30, 30), (20, 80, 200)
SQUARE = np.array([[10.0, 10.0], [60.0, 10.0], [60.0, 60.0], [10.0, 60.0]])


def operators(*parts):
    """Return what a page is told to draw: operators with their numbers."""
    picture = Illustration("", "", lambda size: Drawing(*size, parts), (80.0, 80.0))
    report = Report("x", "y", date(2026, 1, 1), (Sheet("z", (picture,)),))
    page = opened(pdf_bytes(report)).pages[0]
    return page, page.get_contents().get_data().decode("latin-1")


def colour(rgb):
    return " ".join(f"{one / 255:.3f}".rstrip("0").rstrip(".") for one in rgb)


@pytest.mark.parametrize(
    ("part", "sign"),
    [
        (Strokes((SQUARE,), RED, 0.5), "RG"),
        (Segments(np.array([[1.0, 2, 30, 2]]), RED, 0.5), "RG"),
        (Areas((SQUARE,), fill=RED), "rg"),
        (Areas((SQUARE,), edge=RED), "RG"),
        (Discs(SQUARE, 1.0, fill=RED), "RG"),
        (Discs(SQUARE, 1.0, fill=RED, edge=BLUE), "rg"),
    ],
)
def test_each_part_is_drawn_in_its_colour(part, sign):
    _, data = operators(part)
    shown = [f"{one:.10g}" for one in (round(c / 255, 4) for c in RED)]
    lines = [line for line in data.splitlines() if line.strip().endswith(sign)]
    assert any(
        all(abs(float(a) - float(b)) < 0.005 for a, b in zip(line.split()[:3], shown, strict=True))
        for line in lines if len(line.split()) == 4
    )  # fmt: skip


def test_a_line_lies_where_the_drawing_has_it():
    _, data = operators(Segments(np.array([[10.0, 20.0, 40.0, 20.0]]), RED, 0.5))
    # the drawing's corner is 12 mm from the left and 29 mm from the top of 297
    want = [(12 + 10) * MM, (297 - 29 - 20) * MM, (12 + 40) * MM, (297 - 29 - 20) * MM]
    found = [line.split() for line in data.splitlines() if " m " in line and " l " in line]
    numbers = [[float(one[0]), float(one[1]), float(one[3]), float(one[4])] for one in found]
    assert any(one == pytest.approx(want, abs=0.02) for one in numbers)


def test_words_stand_at_their_place():
    page, _ = operators(Lettering(100.0, 30.0, "Norden", 8.0, anchor="end"))
    seen = {}
    page.extract_text(visitor_text=lambda text, cm, tm, *_: seen.update({text.strip(): (cm, tm)}))
    cm, tm = seen["Norden"]
    x, y = (tm[4] + cm[4]) / MM, (tm[5] + cm[5]) / MM
    assert 12 + 100 - 12 < x < 12 + 100 - 5
    assert 297 - y == pytest.approx(29 + 30 + 1, abs=1.0)


def test_a_picture_is_in_the_file_pixel_for_pixel():
    pixels = np.zeros((5, 7, 3), np.uint8)
    pixels[2, 3] = RED
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, "PNG")
    page, _ = operators(Bitmap(0, 0, 70, 50, file.getvalue()))
    (image,) = page.images
    assert (np.asarray(image.image.convert("RGB")) == pixels).all()


def test_many_parts_do_not_change_how_words_look_afterwards():
    parts = (Strokes((SQUARE,), RED, 2.0, dashed=True), Discs(SQUARE, 2, BLUE, RED))
    page, data = operators(*parts, Lettering(5, 5, "after", 8.0))
    assert "after" in page.extract_text()
    # a dashed line is over when its part is
    assert data.count("q") == data.count("Q") or data.split().count("q") == data.split().count("Q")


def test_letters_without_a_font_are_replaced_in_drawings_too():
    picture = Illustration(
        "", "", lambda size: Drawing(*size, (Lettering(5, 5, "葡 9"),)), (20.0, 20.0)
    )
    report = Report("葡", "y", date(2026, 1, 1), (Sheet("z", (picture,)),))
    assert "? 9" in texts(pdf_bytes(report))[0]


def test_a_text_is_as_wide_as_the_font_that_is_set_makes_it_however_often_it_is_asked():
    pdf, texts_ = FPDF(), ("1 667", "Ann", "1 667")
    for family, style, size in (
        ("helvetica", "", 8),
        ("helvetica", "B", 8),
        ("courier", "", 8),
        ("helvetica", "", 9),
    ):
        pdf.set_font(family, style, size)
        for _ in range(2):
            assert [wide_mm(pdf, one) for one in texts_] == [
                pdf.get_string_width(one) for one in texts_
            ]
