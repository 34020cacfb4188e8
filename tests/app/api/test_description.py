"""The description is OpenAPI, and its schemas are schemas."""

import jsonschema

from app.api import description


def test_the_schemas_are_schemas():
    for name in ("FINDING", "FINDINGS", "ASKED", "TAKEN", "ROUTE", "PLOT", "DAY", "ERROR"):
        jsonschema.Draft202012Validator.check_schema(getattr(description, name))


def test_every_operation_says_what_it_answers_and_that_it_needs_a_key():
    made = description.description()
    assert made["security"] == [{"key": []}]
    for path, item in made["paths"].items():
        named = {part.strip("{}") for part in path.split("/") if part.startswith("{")}
        assert {one["name"] for one in item["parameters"]} == named
        for method in item.keys() - {"parameters"}:
            assert item[method]["summary"]
            assert {"200", "401", "403", "503"} <= item[method]["responses"].keys()
