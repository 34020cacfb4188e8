"""The map's component: what it is sent, and who hears of what is done on it."""

import json
import re

import pytest

from app.show import map_view
from app.show.ground import GroundShown
from app.show.map_view import Drawable, MapAnswers, MapContent, Switch
from app.show.maps import deck
from app.state.map_store import STORE
from app.words import texts
from app.words.units import UnitsInLanguage
from fieldmon.drive.vda5050 import watcher
from tests.app.chosen import a_plot
from tests.app.driving import go, map_of
from tests.paths import ROOT


def content(**more):
    layers = [deck.boundary(a_plot().field)]
    return MapContent("here", [1.0, 2.0, 3.0, 4.0], "a map", layers, **more)


@pytest.fixture
def sent(session):  # noqa: ARG001 - read within it
    """Return what the browser is sent, as JSON takes it."""

    def of(content, answers=None):
        return json.loads(json.dumps(map_view.as_data(content, answers or MapAnswers())))

    return of


def test_layers_are_named_by_their_addresses_and_hold_no_content(sent):
    (layer,) = sent(content())["layers"]
    assert layer["id"] == "boundary"
    assert STORE.get(layer["url"]) is not None
    assert set(layer) == {"id", "url"}


def test_switches_and_shades_say_which_layers_they_have_and_whether_they_are_on(sent):
    data = sent(content(switches=(Switch("a", "A", ("x", "y")), Switch("b", "B", (), on=False)),
                        shades=(Switch("c", "C", ("z",)),)))  # fmt: skip
    assert [(one["key"], one["layers"], one["off"]) for one in data["switches"]] == [
        ("a", ["x", "y"], False), ("b", [], True)
    ]  # fmt: skip
    assert data["shades"] == [{"key": "c", "label": "C", "layers": ["z"]}]


def test_what_can_be_done_is_what_somebody_hears_of(sent):
    nobody = sent(content())
    assert not nobody["taps"]
    assert not nobody["select"]
    assert nobody["draw"] is None
    some = sent(content(), MapAnswers(tapped=lambda *_: None, selected=lambda _: None))
    assert some["taps"]
    assert some["select"]


def test_what_is_drawn_has_its_kind_its_hint_and_where_it_snaps(sent):
    draw = sent(content(draw=Drawable("line", "path", "Click.", ((1.0, 2.0),))))["draw"]
    assert draw == {
        "id": "path",
        "kind": "line",
        "hint": "Click.",
        "snap": [[1.0, 2.0]],
        "points": [],
        "lengths": [],
    }


def test_scale_bars_are_in_the_person_s_unit(sent, session):
    assert [100.0, "100\u00a0m"] in sent(content())["lengths"]
    session["length"] = "ft"
    feet = sent(content())["lengths"]
    assert [pytest.approx(30.48), "100\u00a0ft"] in feet
    assert feet == [list(one) for one in UnitsInLanguage(length="ft").lengths()]


@pytest.fixture
def told(session):
    """Return what tells the server of something done on the map, and what was heard."""
    heard = []
    answers = MapAnswers(
        tapped=lambda *what: heard.append(("tapped", *what)),
        drawn=lambda *what: heard.append(("drawn", *what)),
        selected=lambda *what: heard.append(("selected", *what)),
    )

    def tell(**what):
        session[map_view.KEY] = what
        map_view._heard(answers)
        return heard

    return tell


def test_taps_drawings_and_selections_are_heard_as_what_they_are(told):
    told(tapped={"layer": "plants-chance", "index": 7.0})
    told(drawn={"kind": "no_go", "points": [[1, 2], [3, 4.5]]})
    assert told(selected={"runs": [[3, 5], [9, 9]]}) == [
        ("tapped", "plants-chance", 7),
        ("drawn", "no_go", ((1.0, 2.0), (3.0, 4.5))),
        ("selected", (3, 4, 5, 9)),
    ]


def test_what_is_selected_by_now_is_told_in_runs_of_numbers(sent):
    some = MapAnswers(selected=lambda _: None, picked=(9, 3, 4, 5, 11))
    assert sent(content(), some)["picked"] == [[3, 5], [9, 9], [11, 11]]
    assert sent(content())["picked"] == []


def test_no_more_plants_are_taken_than_the_map_offers(told):
    ((_, plants),) = told(selected={"runs": [[0, 2_000_000_000]]})
    assert len(plants) == 20_000


def test_the_ground_lies_below_all_else_can_be_switched_and_names_its_source(sent):
    shown = GroundShown((deck.ArraysLayer("BitmapLayer", {"image": b"x"}, id="ground-picture"),),
                        "somebody", is_picture=True)  # fmt: skip
    data = sent(content(ground=shown))
    assert [one["id"] for one in data["layers"]] == ["ground-picture", "boundary"]
    assert data["ground"] == {"ids": ["ground-picture"], "credit": "somebody", "picture": True,
                              "worker": ""}  # fmt: skip
    assert data["switches"][-1]["layers"] == ["ground-picture"]
    assert sent(content())["switches"] == []


def test_only_what_was_done_is_heard_and_only_by_who_asked_for_it(session):
    done = {"tapped": {"layer": "x", "index": 1}, "drawn": None, "selected": {"runs": [[1, 2]]}}
    session[map_view.KEY], heard = dict(done), []
    map_view._heard(MapAnswers(drawn=lambda *what: heard.append(what), selected=heard.append))
    assert heard == [(1, 2)]
    map_view._heard(MapAnswers())
    assert heard == [(1, 2)]
    assert session[map_view.KEY] == done


def test_a_page_sends_little_however_many_plants_it_shows(app):
    data = map_of(app)
    bare = {**data, "layers": [{"id": one["id"], "url": one["url"]} for one in data["layers"]]}
    text = json.dumps({**bare, "labels": [], "play": None})
    assert len(text) < 20_000


def test_what_did_not_change_keeps_its_address_so_that_no_browser_fetches_it_again(app):
    def urls():
        return {one["id"]: one["url"] for one in map_of(app)["layers"]}

    first = urls()
    go(app, "compare")
    assert urls() == first
    go(app, "today")
    app.slider(key="hours Robot").set_value(3.0).run()
    shorter = urls()
    assert shorter["plants-chance"] == first["plants-chance"]
    assert shorter["route"] != first["route"]


def test_every_word_of_the_map_is_one_that_its_script_shows():
    folder = ROOT / "app" / "map_view" / "src"
    source = "".join(path.read_text(encoding="utf-8") for path in sorted(folder.glob("*.js")))
    asked = set(re.findall(r"\b(?:words|said)\.([a-z_]+)\b(?!\()", source))
    # how a robot stands is shown by its own word: the watcher's, the page's, the script's
    assert 'words[standing === "lost" && lag === null ? "lost_before" : standing]' in source
    stands = {watcher.WAITING, watcher.LIVE, watcher.PAUSED, watcher.FAILED, watcher.LOST}
    stands |= {watcher.IDLE, watcher.HELD, watcher.DONE, watcher.OFF}
    stands |= {watcher.ELSEWHERE, watcher.DOUBLE, "lost_before"}
    # beside its name on the map, where there is room for a word
    assert "this.words[`robot_${robot.heard?.standing}`]" in source
    in_short = {"robot_paused", "robot_lost", "robot_failed", "robot_held", "robot_done",
                "robot_off", "robot_double"}  # fmt: skip
    assert in_short <= {f"robot_{one}" for one in stands}
    link = {"ended", "away", "unheard"}
    assert asked | stands | in_short | link == set(texts.MAP_WORDS)


def test_the_browser_is_sent_the_same_in_few_bytes():
    data = {"alt": "מפה", "layers": [{"id": "plants", "url": "/a"}], "play": None, "at": [1.5, -2]}
    sent = map_view.as_bytes(data)
    assert json.loads(sent) == data
    assert len(sent) < len(json.dumps(data))
    assert "מפה".encode() in sent
