"""Symbols, labels and forms as QGIS writes them."""

from xml.etree import ElementTree as ET

from fieldmon.io.writers.qml import Symbol, choice_list, labelled, numbered, qml, single


def test_a_symbol_says_its_colour_to_new_programs_and_old_ones():
    symbol = ET.fromstring(Symbol("marker", "1,2,3,255", 2.5, "diamond").qml("7"))  # noqa: S314
    assert symbol.get("name") == "7"
    new = {o.get("name"): o.get("value") for o in symbol.iter("Option") if o.get("name")}
    old = {p.get("k"): p.get("v") for p in symbol.iter("prop")}
    assert new == old
    assert (new["color"], new["size"], new["name"]) == ("1,2,3,255", "2.5", "diamond")


def test_a_choice_list_says_what_is_read_and_what_is_written():
    field = ET.fromstring(choice_list("found", (("found <1>", "yes"), ("clean", "no"))))  # noqa: S314
    said = [(o.get("name"), o.get("value")) for o in field.iter("Option") if o.get("value")]
    assert said == [("found <1>", "yes"), ("clean", "no")]
    assert field.find("editWidget").get("type") == "ValueMap"


def test_a_style_with_labels_and_a_form_is_xml():
    inside = labelled("\"stop\" || ' <'") + numbered("count")
    style = ET.fromstring(qml(inside, "Labeling|Forms"))  # noqa: S314 - our own
    assert style.find(".//text-style").get("fieldName") == "\"stop\" || ' <'"
    assert ET.fromstring(single(Symbol("line", "0,0,0,255"))).find("renderer-v2") is not None  # noqa: S314
