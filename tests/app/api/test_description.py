"""The description is OpenAPI, its schemas are schemas, and the scout's page sends all of them."""

import re

import jsonschema

from app.api import description
from tests.paths import ROOT


def test_the_schemas_are_schemas():
    for name in ("FINDING", "FINDINGS", "ASKED", "TAKEN", "ROUTE", "PLOT", "DAY", "ERROR"):
        jsonschema.Draft202012Validator.check_schema(getattr(description, name))


def test_the_scouts_page_sends_every_field_of_a_finding_and_no_other():
    store = (ROOT / "app" / "scout_page" / "src" / "store.js").read_text(encoding="utf-8")
    sent = re.findall(r'"(\w+)"', re.search(r"const SENT = \[(.*?)\];", store, re.DOTALL)[1])
    assert sorted(sent) == sorted(description.FINDING["properties"])


def test_every_operation_says_what_it_answers_and_that_it_needs_a_key():
    made = description.description()
    assert made["security"] == [{"key": []}]
    for path, item in made["paths"].items():
        named = {part.strip("{}") for part in path.split("/") if part.startswith("{")}
        assert {one["name"] for one in item["parameters"]} == named
        for method in item.keys() - {"parameters"}:
            assert item[method]["summary"]
            assert {"200", "401", "403", "503"} <= item[method]["responses"].keys()
