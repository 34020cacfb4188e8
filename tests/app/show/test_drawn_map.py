"""The map on which a plot is drawn: where it begins, what it measures by, what is written on it."""

from types import SimpleNamespace

import numpy as np
import pytest
import streamlit as st

from app.show import drawn_map
from app.state import drawn_plot, ground
from app.state.drawn_plot import DrawnCorners
from app.state.kept_ground import Agreement
from app.words.units import UnitsInLanguage
from fieldmon.plot.projection import Frame

UNITS = UnitsInLanguage()
AT = (34.9, 31.5)
SQUARE = (AT, (34.902, 31.5), (34.902, 31.502), (34.9, 31.502))


@pytest.fixture(autouse=True)
def device(session, monkeypatch):  # noqa: ARG001 - a page of its own
    device = SimpleNamespace(timezone="Asia/Jerusalem", locale="en", theme={}, headers={})
    monkeypatch.setattr(st, "context", device)
    return device


def made(draft=None, units=UNITS):
    return drawn_map.content(draft or DrawnCorners(), units, dark=False)


def holds(bounds, lon, lat):
    west, south, east, north = bounds
    return west < lon < east and south < lat < north


def test_it_begins_at_the_country_of_the_device_without_asking_anybody(device):
    assert holds(made().bounds, 35, 31.5)
    assert not holds(made().bounds, 77, 20)
    assert [layer.id for layer in made().layers] == ["zones"]
    device.timezone = "Asia/Calcutta"  # as browsers call it still
    assert holds(made().bounds, 77, 20)
    assert made().bounds[0] > 60
    for unknown in ("UTC", None, "Mars/Olympus"):
        device.timezone = unknown
        assert holds(made().bounds, 77, 20)
        assert holds(made().bounds, -60, -20)


def test_a_place_that_was_found_is_seen_from_near_with_a_grid_of_round_lengths():
    content = made(DrawnCorners(at=AT))
    low, high = Frame(*AT).xy_m(np.reshape(content.bounds, (2, 2)))
    assert (low.round(), high.round()) == (pytest.approx([-200, -200]), pytest.approx([200, 200]))
    near, far = content.layers
    for layer, step_m in ((near, 10), (far, 100)):
        east = [Frame(*AT).xy_m(line["path"])[0, 0] for line in layer.data[::2]]
        assert np.diff(east) == pytest.approx(step_m, abs=0.02)
    (part,) = content.legend
    assert part["items"][0][2].replace("\u00a0", " ") == "grid of 10 m and 100 m"
    feet = made(DrawnCorners(at=AT), UnitsInLanguage(length="ft")).legend[0]["items"][0][2]
    assert feet.replace("\u00a0", " ") == "grid of 20 ft and 200 ft"


def test_what_is_tapped_does_not_move_the_map():
    places = {made(DrawnCorners(SQUARE[:n], AT)).place for n in range(5)}
    assert len(places) == 1
    assert len({made(DrawnCorners(SQUARE[:n])).place for n in range(5)}) == 1
    assert made(DrawnCorners(at=SQUARE[1])).place not in places
    drawn_plot.drawn_anew()
    assert made(DrawnCorners(SQUARE, AT)).place not in places, (
        "a corner that is typed may be out of view"
    )


def test_what_is_drawn_is_said_with_its_area_and_how_its_edges_are_written():
    content = made(DrawnCorners(SQUARE))
    assert content.draw.hint.replace("\u00a0", " ") == "4 corners, 4.21 ha"
    assert (content.draw.kind, content.draw.points) == ("outline", SQUARE)
    assert content.draw.lengths == (
        (0.0, 1.0, "0", "{n}\u00a0m"),
        (1e3, 1e3, "0.00", "{n}\u00a0km"),
    )
    assert all(holds(content.bounds, *corner) for corner in SQUARE)
    assert "ha" not in made(DrawnCorners(SQUARE[:2])).draw.hint


def test_a_map_of_the_world_that_was_agreed_to_lies_below_and_the_grid_gives_way():
    assert made(DrawnCorners(at=AT)).switches[0].on
    ground.agree(None, Agreement("https://tiles.example/{z}/{x}/{y}.png", "example", "2026-11-28"))
    content = made(DrawnCorners(at=AT))
    assert [layer.id for layer in content.ground.layers] == ["ground-map"]
    assert content.ground.worker
    assert not content.switches[0].on
