"""The page's own styles name parts of Streamlit's page that this Streamlit has."""

import re
from functools import cache
from pathlib import Path

import pytest
import streamlit

from app.show.maps import colours

STYLES = sorted((Path(__file__).parents[2] / "app" / "style").glob("*.css"))
STATIC = Path(streamlit.__file__).parent / "static"


@cache
def script():
    return "".join(one.read_text(errors="replace") for one in STATIC.rglob("*.js"))


@pytest.mark.parametrize("style", STYLES, ids=lambda one: one.stem)
def test_every_part_of_streamlit_that_a_style_names_is_there(style):
    css = re.sub(r"/\*.*?\*/|url\(.*?\)", "", style.read_text(), flags=re.DOTALL)
    attributes = {*re.findall(r"\[(data-[\w-]+)", css)} - {"data-panel-folded"}
    named = {*re.findall(r"\[data-testid\^?=(\w+)", css), *re.findall(r"\.(st[A-Z]\w*)", css)}
    gone = {name for name in attributes | named if name not in script()}
    assert not gone


def test_days_and_times_are_read_from_the_left_in_every_language():
    (style,) = (one for one in STYLES if one.stem == "right_to_left")
    (parts,) = re.findall(r"(.*)>div:last-child\{direction:ltr\}", style.read_text())
    assert {*re.findall(r"data-testid=(\w+)", parts)} == {"stDateInput", "stTimeInput"}


def test_found_and_clean_have_the_colours_that_they_have_on_the_phone():
    app = Path(__file__).parents[2] / "app"
    phone = (app / "scout_page" / "src" / "style.css").read_text().splitlines()
    for style, said in (("every_page", phone[0]), ("dark", phone[1])):
        here = (app / "style" / f"{style}.css").read_text()
        for ours, theirs in (("clean", "clean"), ("found", "found"), ("on-answer", "on")):
            (colour,) = re.findall(rf"--{theirs}: (#\w+);", said)
            assert f"--{ours}:{colour}" in here


def test_the_route_and_what_was_treated_are_told_apart_on_a_dark_ground_too():
    for route, treated in ((colours.ROUTE, colours.TREATED),
                           (colours.ROUTE_IN_DARK, colours.TREATED_IN_DARK)):  # fmt: skip
        assert sum(abs(a - b) for a, b in zip(route, treated, strict=True)) > 100


@pytest.mark.parametrize(
    ("said", "number_first"), [("10 م", False), ("10 מ׳", False), ("10 m", True)]
)
def test_the_scale_bar_has_number_and_unit_in_the_order_of_its_language(
    browser, said, number_first
):
    css = (Path(__file__).parents[2] / "app" / "map_view" / "src" / "style.css").read_text()
    page = browser.new_page()
    page.set_content(f"<style>{css}</style><div class=scale><div class=text>{said}</div></div>")
    first, last = page.evaluate("""() => {
      const text = document.querySelector(".text").firstChild, range = document.createRange();
      return [[0, 1], [3, 4]].map(([from, to]) => {
        range.setStart(text, from);
        range.setEnd(text, to);
        return range.getBoundingClientRect().left;
      });
    }""")
    page.close()
    assert (first < last) == number_first
