"""A page is whole, asks for nothing, and takes no text for markup."""

import subprocess
import sys

import jinja2
import pytest
from markupsafe import Markup

from fieldmon.io import html
from tests.pages import HOSTILE, Page, held
from tests.paths import ROOT

TEMPLATES = sorted(
    path.relative_to(ROOT).as_posix()
    for room in ("fieldmon", "app")
    for path in (ROOT / room).rglob("*.j2")
)
PAGES = [name for name in TEMPLATES if not name.startswith("fieldmon/io/templates/")]


@pytest.fixture
def made(monkeypatch):
    """Return what fills a template of the test's own."""
    environment = html._environment()
    own = environment.overlay(loader=None)

    def fill(body, **values):
        source = (
            '{% extends "fieldmon/io/templates/page.html.j2" %}{% block kind %}study{% endblock %}'
            "{% block title %}{{ title }}{% endblock %}{% block body %}" + body + "{% endblock %}"
        )
        own.loader = jinja2.ChoiceLoader([jinja2.DictLoader({"own": source}), environment.loader])
        monkeypatch.setattr(html, "_environment", lambda: own)
        return html.page("own", **values)

    return fill


def test_a_page_is_a_document_with_its_style_inside(made):
    source = made("<p>{{ said }}</p>", title="A title", said="Said.")
    assert source.startswith("<!doctype html>\n<html")
    page = Page(source)
    assert page.tags.count("html") == page.tags.count("body") == page.tags.count("style") == 1
    assert page.text.split() == ["A", "title", "Said."]
    assert page.asks_for == []
    assert "prefers-color-scheme: dark" in page.styles


@pytest.mark.parametrize("text", HOSTILE)
def test_a_text_is_text_wherever_it_is_put(made, text):
    body = '<p title="{{ said }}">{{ said }}</p>'
    page = held(made(body, title=text, said=text), [text])
    assert page.text.count(text) == 2
    assert ("title", text) in page.attributes
    assert page.tags.count("p") == 1
    assert "b" not in page.tags


def test_a_drawing_that_is_called_safe_is_put_in_as_it_is(made):
    page = Page(made("{{ drawing }}", title="t", drawing=Markup("<svg><path d='M0 0'/></svg>")))
    assert {"svg", "path"} <= set(page.tags)


def test_a_blank_that_nobody_fills_in_is_an_error(made):
    with pytest.raises(jinja2.UndefinedError, match="said"):
        made("<p>{{ said }}</p>", title="t")


def test_a_stylesheet_for_paper_and_for_the_dark_stands_once():
    # those of the app dress Streamlit's own pages
    assert [path.name for path in (ROOT / "fieldmon").rglob("*.css")] == ["page.css"]
    for path in (*(ROOT / "fieldmon").rglob("*.py"), ROOT / "app" / "show" / "report.py"):
        assert "<style" not in path.read_text("utf-8")


@pytest.mark.parametrize("name", PAGES)
def test_every_template_is_a_page_whose_kind_the_stylesheet_knows(name):
    source = (ROOT / name).read_text("utf-8")
    assert source.startswith('{% extends "fieldmon/io/templates/page.html.j2" %}')
    template = html._environment().get_template(name)
    (kinds,) = template.blocks["kind"](template.new_context())
    style = (ROOT / "fieldmon/io/templates/page.css").read_text("utf-8")
    assert kinds.split()
    assert all(f".{kind} " in style or f".{kind}," in style for kind in kinds.split())


@pytest.mark.parametrize("name", TEMPLATES)
def test_only_what_the_program_draws_is_called_safe(name):
    source = (ROOT / name).read_text("utf-8")
    assert "autoescape" not in source
    assert source.count("|safe") == (1 if name.endswith("report.html.j2") and "app/" in name else 0)


def test_jinja_is_loaded_when_a_page_is_made_and_not_before():
    code = "import sys, fieldmon.io.html, fieldmon.io.writers; print('jinja2' in sys.modules)"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert said.stdout.strip() == "False"
