"""A day on the scout's page without a network, in a real browser that is killed, and the way back.

`FIELDMON_DAY=120 FIELDMON_PHOTOS=20` for the whole day that a release is held to.
"""

import hashlib
import os
import random
import re
import shutil
from dataclasses import replace
from datetime import date

import numpy as np
import pytest

from app.api import documents
from app.state.scout_page import invitation
from app.words import texts
from fieldmon.infestation.inspections import CLEAN, FOUND
from fieldmon.monitoring import Season
from fieldmon.monitoring.days.day_ahead import WorkPart, planned_again, route_ahead
from fieldmon.monitoring.estimates.what_was_told import detection_of
from fieldmon.monitoring.phones import photos, scouts
from fieldmon.monitoring.phones.findings import take
from fieldmon.monitoring.phones.photos_asked import ask_photo, photos_asked
from fieldmon.plot.grid import plant_numbers
from fieldmon.plot.local_clock import utc_now
from tests.app.driving import until
from tests.app.scouting import BrokenLine, Line, PhoneBrowser, PhoneWindow, a_picture, kept
from tests.app.test_hostile_texts import EVIL, NAMES, hostile_season
from tests.monitoring.phone import a_finding, told
from tests.monitoring.rules import keeps_the_rules
from tests.monitoring.seasons import BEGINS, a_plot, a_season

PLANTS = int(os.environ.get("FIELDMON_DAY", "8"))
PHOTOS = int(os.environ.get("FIELDMON_PHOTOS", "2"))
CUTS = int(os.environ.get("FIELDMON_CUTS", "12"))
KILLS = int(os.environ.get("FIELDMON_KILLS", "1"))
#: what a page would run, draw or follow if it were not text
HARM = " ".join(NAMES[:5])
SENT = "#sync[data-state=sent][data-left='0']"


@pytest.fixture(scope="module")
def planned_file(tmp_path_factory):
    season = a_season(tmp_path_factory.mktemp("planned") / "Gate 2026.gpkg")
    season.plan(BEGINS)
    return season.path


@pytest.fixture
def season(planned_file, tmp_path):
    """Return a season of its own: a whole day of tapping leaves nothing to the next test."""
    folder = tmp_path / "seasons"
    folder.mkdir()
    return Season(shutil.copy(planned_file, folder))


@pytest.fixture(scope="module")
def one_port():
    """Return a line whose address stays: a phone keeps the page by it."""
    return Line()


@pytest.fixture
def line(season, one_port, monkeypatch):
    monkeypatch.setenv("FIELDMON_SEASONS", str(season.path.parent))
    one_port.come()
    yield one_port
    one_port.go()


@pytest.fixture(scope="module")
def window(browser):
    """Return a phone that lasts: a window that shares nothing but the browser's processes."""
    window = PhoneWindow(browser)
    yield window
    window.close()


@pytest.fixture
def phone(window, one_port):
    """Return that phone, which has the page, but knows nobody and no season."""
    window.forget(one_port.address)
    return window


@pytest.fixture
def mortal_phone(browser, tmp_path):
    """Return a phone whose browser can be killed: started for it, a disk of its own."""
    phone = PhoneBrowser(browser, tmp_path / "phone")
    yield phone
    phone.close()


def invited(phone, line, season, name="Ann"):
    """Scan the code with the network, until all that is needed is on the phone."""
    key = scouts.let_in(season, name)
    phone.page.goto(invitation(line.address, season.path.stem, key, str(BEGINS), "en"))
    phone.page.locator("#clean").wait_for(timeout=120_000)
    phone.page.evaluate("navigator.serviceWorker.ready.then(() => null)")
    phone.page.wait_for_function("() => navigator.serviceWorker.controller !== null")
    return key


def plant_of(page):
    return int(page.locator("#place").get_attribute("data-plant"))


def news(page):
    """Let the page ask what is new: 90 s later, as the network comes."""
    page.evaluate(
        "() => { const { now } = Date; Date.now = () => now() + 90000;"
        " dispatchEvent(new Event('online')); }"
    )


def told_now(page, result, count=None):
    """Say what was found at the next plant; return it once the page has gone on."""
    plant = plant_of(page)
    page.locator("#answers:not([data-resting])").wait_for()
    if result == "found":
        page.locator("#found").click()
        if count is not None:
            page.locator("#count").fill(str(count))
        page.locator("#save").click()
    else:
        page.locator(f"#{result}").click()
    page.locator(f"#place:not([data-plant='{plant}'])").wait_for()
    page.locator(f"#last[data-plant='{plant}'][data-kept=true]").wait_for()
    return plant, result


@pytest.mark.timeout(1800)
def test_a_day_without_a_network_among_kills_loses_and_doubles_nothing(season, line, mortal_phone):
    """Killed in the moment of a tap, it is whole or asked for again."""
    phone = mortal_phone
    invited(phone, line, season)
    line.go()
    rng, said = random.Random(4), []
    pictured = set(rng.sample(range(PLANTS), PHOTOS))
    broken = ["reload", "tab", "browser"] * max(1, PLANTS // 12)
    breaks = dict(zip(rng.sample(range(PLANTS), len(broken)), broken, strict=True))
    for k in range(PLANTS):
        page = phone.page
        if k in pictured:
            page.locator("#camera").set_input_files(a_picture(k))
            page.locator("#photos").wait_for()
        if k in breaks:  # with the photo taken, and nothing said yet
            before = plant_of(page)
            {"reload": page.reload, "tab": phone.crash_tab, "browser": phone.kill}[breaks[k]]()
            page = phone.page
            if breaks[k] != "reload":
                page.goto(f"{line.address}/scouting/")
            page.locator("#clean").wait_for()
            assert plant_of(page) == before
            assert (page.locator("#photos").count() == 1) == (k in pictured)
        result = rng.choice(["clean", "clean", "clean", "found", "skipped"])
        said.append(told_now(page, result, 3 if result == "found" else None))
    for k in range(KILLS):
        said += _killed_at_a_tap(phone, line, [plant for plant, _ in said], drawn=k % 2)
    there = kept(phone.page)
    assert sorted((one["plant"], one["result"]) for one in there.records) == sorted(said)
    assert len(there.photos) == PHOTOS
    line.come()
    phone.page.evaluate("dispatchEvent(new Event('online'))")
    phone.page.locator(SENT).wait_for(timeout=120_000)
    holds(season, there, said)
    assert kept(phone.page).photos == {}, "what the season has needs no room on the phone"


def _killed_at_a_tap(phone, line, told_before, *, drawn):
    """Kill the browser in the moment of a tap; return what it has of it, if anything."""
    before = plant_of(phone.page)
    phone.page.locator("#answers:not([data-resting])").wait_for()
    at_once = phone.page.evaluate(
        "() => { document.querySelector('#clean').click();"
        " return Number(document.querySelector('#place').dataset.plant); }"
    )
    assert at_once != before, "the next plant is there with the tap"
    if drawn:  # the disk may have it by then, or not
        phone.page.evaluate("() => new Promise((done) => requestAnimationFrame(done))")
    phone.kill()
    phone.page.goto(f"{line.address}/scouting/")
    phone.page.locator("#clean").wait_for()
    records = [one["plant"] for one in kept(phone.page).records]
    is_kept = before in records
    assert is_kept or plant_of(phone.page) == before, "what was not kept is asked for again"
    assert sorted(records) == sorted([*told_before, before] if is_kept else told_before)
    return [(before, "clean")] if is_kept else []


def test_what_a_phone_was_planned_to_find_holds_though_another_robot_is_set_meanwhile(
    season, line, phone
):
    invited(phone, line, season)
    line.go()
    told_now(phone.page, "clean")
    sees_less = replace(season.settings.robot, look_s=20.0)
    season.change(replace(season.settings, robot=sees_less), season.settings)
    with season.as_now(BEGINS):
        season.plan(BEGINS)
    told_now(phone.page, "found", 2)
    line.come()
    phone.page.evaluate("dispatchEvent(new Event('online'))")
    phone.page.locator(SENT).wait_for(timeout=120_000)
    now = Season(season.path)
    assert detection_of(now, BEGINS) == 0.5
    assert now.history.detections.tolist() == [0.84, 0.84]
    assert [(one.who, one.n, one.own) for one in now.other_detections(BEGINS)] == [("Ann", 2, 0.5)]


_NO_DISK = """() => {
  const open = IDBFactory.prototype.open;
  IDBFactory.prototype.open = function (...told) {
    if (!window.diskIsBack) throw new DOMException("no disk", "UnknownError");
    return open.apply(this, told);
  };
}"""


_FULL = """() => {
  window.diskIsBack = true;
  IDBObjectStore.prototype.put = () => { throw new DOMException("full", "QuotaExceededError"); };
}"""


def test_a_phone_that_keeps_nothing_is_said_and_work_begins_when_it_does(season, line, phone):
    invited(phone, line, season)
    line.go()
    phone.page.add_init_script(f"({_NO_DISK})()")
    phone.page.reload()
    phone.page.get_by_role("alert").get_by_text(str(texts.SCOUT_PAGE["no_disk"])).wait_for()
    phone.page.evaluate("() => { window.diskIsBack = true; }")
    phone.page.locator("#clean").wait_for()
    assert phone.page.get_by_role("alert").count() == 0
    phone.page.add_init_script(f"({_FULL})()")
    phone.page.goto("about:blank")
    phone.page.goto(invitation(line.address, "Other", "a-key", str(BEGINS), "en"))
    phone.page.locator("#note.bad", has_text="The phone is full").wait_for()
    phone.page.locator("#clean").wait_for()  # what it has, it shows


# a network comes, so often; each time until the page says how it went
_SENT_AGAIN = """async (times) => {
  for (let k = 0; k < times; k++) {
    let began = false;
    const over = new Promise((done) => {
      const look = () => {
        const { state } = document.querySelector("#sync").dataset;
        if (state === "sending") began = true;
        else if (began) { watching.disconnect(); done(); }
      };
      const watching = new MutationObserver(look);
      watching.observe(document.body, { subtree: true, childList: true });
    });
    dispatchEvent(new Event("online"));
    await over;
  }
}"""


@pytest.mark.timeout(3600)
def test_a_line_that_breaks_at_any_byte_loses_and_doubles_nothing(season, line, phone, monkeypatch):
    broken, said = BrokenLine(line.port, seed=5), []
    monkeypatch.setattr(line, "address", broken.address)
    invited(phone, line, season, "Eve")
    page, rng = phone.page, random.Random(6)
    broken.is_broken, photos_taken = True, 0
    while broken.cuts < CUTS:
        if page.locator("#sync[data-left='0']").count() or rng.random() < CUTS / 4000:
            if rng.random() < 0.3:
                page.locator("#camera").set_input_files(a_picture(len(said)))
                page.locator("#photos").wait_for()
                photos_taken += 1
            said.append(told_now(page, "clean"))
        if rng.random() < 0.05:  # and the server is stopped and comes again
            line.go()
            line.come()
        page.evaluate(_SENT_AGAIN, min(10, CUTS // 4))
    there = kept(page)
    broken.is_broken = False
    page.evaluate("() => { dispatchEvent(new Event('online')); }")
    page.locator(SENT).wait_for(timeout=120_000)
    ids, rows = told(Season(season.path))
    mine = {one["id"] for one in there.records}
    assert len(ids) == len(set(ids))
    assert mine <= set(ids)
    assert sorted((plant, result) for one, plant, result in rows if one in mine) == sorted(said)
    for name, (_, _, digest) in there.photos.items():
        assert hashlib.sha256(photos.picture(season, name)[1]).hexdigest() == digest
    assert kept(page).photos == {}
    own = [one for one in photos.photos_of(Season(season.path)) if one.scout == "Eve"]
    assert len(own) == photos_taken
    broken.close()


def holds(season, there, said):
    """Hold the season to what the phone had: records once, photos byte for byte."""
    season = Season(season.path)
    ids, rows = told(season)
    assert sorted(ids) == sorted(one["id"] for one in there.records)
    assert sorted((plant, result) for _, plant, result in rows) == sorted(said)
    for name, (_, _, digest) in there.photos.items():
        kind, data = photos.picture(season, name)
        assert (kind, hashlib.sha256(data).hexdigest()) == ("image/jpeg", digest)
    assert len(photos.photos_of(season)) == PHOTOS
    keeps_the_rules(season.path)


def test_a_tap_is_of_the_plant_in_large_print_whoever_records_it_meanwhile(season, line, phone):
    invited(phone, line, season, "Dan")
    page = phone.page
    page.locator(SENT).wait_for()
    plant = plant_of(page)
    other = phone.window.new_page()
    other.goto(f"{line.address}/scouting/")
    other.locator("#found").click()
    page.locator("#save").wait_for()  # as in the other window
    page.locator("#cancel").click()
    other.locator("#clean").wait_for()
    theirs = a_finding(plant, FOUND, on=BEGINS, at=utc_now())
    take(season, scouts.let_in(season, "Ann"), [theirs], utc_now())
    news(page)
    page.locator("#place", has_text="Ann").wait_for()
    assert plant_of(page) == plant
    told_now(page, "clean")
    assert [one["plant"] for one in kept(page).records] == [plant]


def test_a_newer_plan_is_said_and_loaded_by_whoever_wants_it(season, line, phone, monkeypatch):
    invited(phone, line, season, "Dan")
    page = phone.page
    page.locator(SENT).wait_for()
    plant = plant_of(page)
    ahead = [one for one in route_ahead(season, BEGINS, WorkPart(name="Dan")).plant if one != plant]
    theirs = [a_finding(one, CLEAN, on=BEGINS, at=utc_now()) for one in ahead[:9]]
    take(season, scouts.let_in(season, "Ann"), theirs, utc_now())
    plan = planned_again(season, BEGINS, WorkPart(name="Dan"))
    closed = [{"rows": [1, int(season.plant_numbers.line.max())], "until": "2999-04-06T07:00"}]
    monkeypatch.setattr(documents, "_closed", lambda *_: closed)
    news(page)
    page.locator("#newer").wait_for()
    assert plant_of(page) == plant
    page.locator("#newer").click()
    page.locator("#newer").wait_for(state="hidden")
    page.locator(f"#place[data-plant='{plan.plant[0]}']").wait_for()
    page.locator("#closed", has_text="Sprayed: do not enter before").wait_for()
    page.locator("#open_menu").click()
    page.locator("#menu .bad", has_text="Rows 1 to ").wait_for()


def test_a_phone_says_what_waits_and_what_the_season_took_back_and_takes_no_half_pests(
    season, line, phone
):
    invited(phone, line, season)
    page = phone.page
    page.locator(SENT).wait_for()
    page.locator("#found").click()
    page.locator("#save").wait_for()
    assert not page.locator("#undo").count(), "beside what is not saved yet"
    page.locator("#cancel").click()
    plant = plant_of(page)
    told_now(page, "clean")
    page.locator("#undo").wait_for()
    page.locator(SENT).wait_for()
    season.undo()
    news(page)
    page.locator("#taken_back").click()
    numbered = season.plant_numbers
    name = f"Row {numbered.line[plant]}, plant {numbered.number[plant]}: Clean"
    page.locator("#menu li", has_text=name).wait_for()
    page.locator("#tell_again").click()
    page.locator("#taken_back").wait_for(state="hidden")
    until(lambda: plant in season.history.inspections.plant)
    page.locator(SENT).wait_for()
    _without_a_network(phone, numbered)


def _without_a_network(phone, numbered):
    """Find pests at a plant, and come back to it, while nothing can be sent."""
    page = phone.page
    phone.window.set_offline(True)
    page.locator("#sync[data-state=offline]").wait_for()
    plant = plant_of(page)
    page.locator("#place", has_text="Chance").wait_for()
    page.locator("#found").click()
    for count in ("2.5", "0"):
        page.locator("#count").fill(count)
        page.locator("#save").click()
        page.locator("#note.bad", has_text="whole number").wait_for()
        assert plant_of(page) == plant
    page.locator("#cancel").click()
    told_now(page, "found", 3)
    assert "✓" not in page.locator("#sync[data-left='1']").inner_text()
    page.locator("#other_plant").click()
    page.locator("#to_row").fill(str(numbered.line[plant]))
    page.locator("#to_plant").fill(str(numbered.number[plant]))
    page.locator("#ok").click()
    page.locator(f"#place[data-plant='{plant}']").wait_for()
    assert "Chance" not in page.locator("#place").inner_text()


def test_a_phone_handed_over_and_taken_to_another_plot_mixes_nothing(season, line, phone):
    invited(phone, line, season, "Noa")
    page, window = phone.page, phone.window
    page.locator(SENT).wait_for()
    window.set_offline(True)
    first = told_now(page, "clean")
    scouts.withdraw_key(season, "Noa")
    window.set_offline(False)
    page.goto("about:blank")
    invited(phone, line, season, "Gil")
    second = told_now(page, "clean")
    page.locator("#sync.bad[data-state=sent][data-left='1']").wait_for()
    page.locator("#open_menu").click()
    page.locator("dialog h2", has_text="Gil").wait_for()
    page.locator("dialog .bad", has_text="Noa").wait_for()
    page.keyboard.press("Escape")
    # a code of another season, without a network
    other = Season(shutil.copy(season.path, season.path.parent / "Other.gpkg"))
    key, problems = scouts.let_in(other, "Bea"), []
    page.on("pageerror", lambda error: problems.append(str(error)))
    window.set_offline(True)
    page.goto("about:blank")
    page.goto(invitation(line.address, "Other", key, str(BEGINS), "en"))
    page.locator("#note.bad", has_text="no network").wait_for()
    window.set_offline(False)
    page.evaluate("() => { dispatchEvent(new Event('online')); }")
    page.locator("#clean").wait_for()
    assert page.locator("#note").inner_text() == ""
    there, _ = told_now(page, "clean")
    beside = window.new_page()
    beside.goto(f"{line.address}/scouting/")
    beside.locator(f"#last[data-plant='{there}']").wait_for()
    page.locator("#open_menu").click()
    page.locator(".season", has_text="Gate 2026").click()
    for one in (page, beside):
        one.locator(f"#last[data-plant='{second[0]}']").wait_for()
    # a code opened where the page is open
    code = invitation(line.address, "Other", key, str(BEGINS), "en")
    page.evaluate("code => { location.href = code; }", code)
    page.wait_for_function("() => location.hash === ''")
    page.locator("#open_menu").click()
    page.locator("dialog h2", has_text="Bea").wait_for()
    beside.locator(f"#last[data-plant='{there}']").wait_for()
    assert problems == []
    with Season(season.path).store.reading() as db:
        assert db.execute("SELECT scout FROM tellings").fetchall() == [("Gil",)]
    assert first[0] in {one["plant"] for one in kept(page).records}


def test_taps_count_once_and_are_sent_when_they_say_so_by_keys_and_by_a_glove_that_bounces(
    season, line, phone
):
    invited(phone, line, season, "Hal")
    page = phone.page
    page.locator(SENT).wait_for()
    first = plant_of(page)
    page.evaluate("() => [1, 2, 3].forEach(() => document.querySelector('#clean').click())")
    page.locator(f"#last[data-plant='{first}'][data-kept=true]").wait_for()
    assert [one["plant"] for one in kept(page).records] == [first]
    page.locator(SENT).wait_for()
    _is_sent_when_it_says_so(page)
    _by_keys_alone(page)
    _is_gone_and_taken_back(page, season)


def _is_sent_when_it_says_so(page):
    """Tap: nothing is called sent between the tap and the sending."""
    page.evaluate(_BARS)
    told_now(page, "clean")
    page.wait_for_function("() => bars.some(([state]) => state === 'sending')")
    bars = page.evaluate("() => bars")
    before = bars[: next(k for k, (state, _) in enumerate(bars) if state == "sending")]
    assert before, "the bar says at once that one waits"
    assert {left for _, left in before} == {"1"}
    page.locator(SENT).wait_for()


def _by_keys_alone(page):
    """Tap and find, and open and close the menu, by the keyboard."""
    page.locator("#answers:not([data-resting])").wait_for()

    def to(name):
        for _ in range(40):
            if page.evaluate("document.activeElement?.id") == name:
                return
            page.keyboard.press("Tab")
        pytest.fail(f"{name} was not reached")

    before, first = kept(page).records, plant_of(page)
    to("clean")
    page.keyboard.press("Enter")
    page.locator(f"#last[data-plant='{first}'][data-kept=true]").wait_for()
    assert page.evaluate("document.activeElement.id") == "clean", "it stays where one taps"
    page.locator("#answers:not([data-resting])").wait_for()
    second = plant_of(page)
    to("found")
    page.keyboard.press("Space")
    page.locator("#details").wait_for()
    to("count")
    page.keyboard.type("4")
    to("save")
    page.keyboard.press("Enter")
    page.locator(f"#last[data-plant='{second}'][data-kept=true]").wait_for()
    to("open_menu")
    page.keyboard.press("Enter")
    page.locator("#close").wait_for()
    page.keyboard.press("Escape")
    page.locator("#close").wait_for(state="hidden")
    said = [(one["plant"], one["result"], one.get("count")) for one in kept(page).records]
    assert {one for one in said if one[0] in {first, second}} == {
        (first, "clean", None), (second, "found", 4),
    }  # fmt: skip
    assert len(said) == len(before) + 2


def _is_gone_and_taken_back(page, season):
    """Say of two plants that they are gone, and take the second back."""
    kept_one, _ = told_now(page, "gone")
    told_now(page, "gone")
    page.locator("#last", has_text="Plant is gone").wait_for()
    page.locator("#undo").click()
    page.locator(f"#last[data-plant='{kept_one}']").wait_for()
    page.locator(SENT).wait_for(timeout=120_000)
    history = Season(season.path).history
    assert np.flatnonzero(history.gone(0)).tolist() == [kept_one]


#: what the bar says, each time that it is drawn
_BARS = """() => {
  window.bars = [];
  const sync = document.querySelector("#sync");
  const drawn = new MutationObserver(() => bars.push([sync.dataset.state, sync.dataset.left]));
  drawn.observe(sync, { attributes: true });
}"""


def test_what_a_scout_does_in_the_field(season, line, phone):
    season = a_season(season.path.parent / "Faces 2026.gpkg", plot=a_plot(faces=2))
    start = route_ahead(season, BEGINS).plant[0]
    lon, lat = season.plot.grid.lonlat([start])[0]
    phone.window.set_geolocation({"longitude": lon, "latitude": lat, "accuracy": 4})
    numbered, plot = season.plant_numbers, season.plot
    key = invited(phone, line, season, "Ben")
    page = phone.page
    page.locator("#place .good", has_text="You are there").wait_for()
    first = plant_of(page)
    row, number = (int(each[0]) for each in plant_numbers(plot.grid, [first]))
    assert re.search(rf"Row\W+{row}, plant\W+{number}, face\W[12]", page.locator("h1").inner_text())
    assert page.locator("#here").count() == 0, "on neither face"
    # the neighbours of a find come next
    told_now(page, "found", 7)
    assert plant_of(page) in _neighbours(plot, first)
    page.locator("#undo").click()
    page.locator(f"#place[data-plant='{first}']").wait_for()
    # off the route, by its row, number and face, with a note
    page.locator("#other_plant").click()
    other = int((plot.grid.row_start[3] + plot.grid.row_start[4]) // 2)
    other = max(other, int(plot.grid.twin[other]))
    page.locator("#to_row").fill(str(numbered.line[other]))
    page.locator("#to_plant").fill(str(numbered.number[other]))
    page.locator("#ok").click()
    assert _asks_for_the_face(page, first) == _faces(plot, other)
    page.locator(f".face[data-plant='{other}']").click()
    page.locator(f"#place[data-plant='{other}']").wait_for()
    page.locator("#here").click()
    assert _asks_for_the_face(page, other) == _faces(plot, first)
    page.get_by_role("button", name="Cancel").click()
    page.locator("#menu:not([open])").wait_for(state="attached")
    page.locator("#map").click()  # in the middle of it, where the plant is now
    assert _asks_for_the_face(page, other) == _faces(plot, other)
    page.get_by_role("button", name="Cancel").click()
    page.locator("#note_button").click()
    page.locator("#notes").fill("webs ב")
    page.locator("#ok").click()
    told_now(page, "found", 2)
    page.locator(SENT).wait_for(timeout=180_000)
    rows = [row for row in told(Season(season.path))[1] if row[1] == other]
    assert [row[2] for row in rows] == ["found"]
    _brings_a_photo_asked_for(page, season)
    # the key is taken back: nothing goes in, nothing is lost
    scouts.withdraw_key(season, "Ben")
    told_now(page, "clean")
    page.locator("#sync[data-state=ended][data-left='1']").wait_for(timeout=180_000)
    assert key not in page.url


def _asks_for_the_face(page, stays):
    """Return the plants among which the page asks, none chosen, while the one in hand stays."""
    faces = page.locator(".face")
    faces.first.wait_for()
    assert page.evaluate("document.activeElement.tagName") == "H2"
    page.locator("#faces:not([data-resting])").wait_for()
    assert plant_of(page) == stays
    return {int(faces.nth(k).get_attribute("data-plant")) for k in range(faces.count())}


def _faces(plot, plant):
    return {plant, int(plot.grid.twin[plant])}


def _brings_a_photo_asked_for(page, season):
    plants = set(range(len(season.plot.grid)))
    plant = min(plants - {*season.plan(BEGINS, keep=False).route.plant.tolist(), plant_of(page)})
    ask_photo(season, plant, "webs under the leaf?")
    page.locator("#open_menu").click()
    page.locator("#load_day").click()
    page.locator("#asked").click()
    page.locator(f"dialog [data-plant='{plant}']").click()
    page.locator(f"#place[data-plant='{plant}'] .asked", has_text="webs under the leaf?").wait_for()
    page.locator("#camera").set_input_files(a_picture(1))
    page.locator(".asked[data-taken=true]").wait_for()
    told_now(page, "clean")
    assert page.locator("#asked").count() == 0
    page.locator(SENT).wait_for(timeout=180_000)
    assert photos_asked(Season(season.path)) == ()
    assert photos.photos_of(Season(season.path))[0].plant == plant


def _neighbours(plot, plant):
    start, others = plot.grid.adjacent
    return others[start[plant] : start[plant + 1]]


def test_it_reads_from_the_right_and_its_targets_are_thumbs(season, line, phone):
    key, other = (scouts.let_in(season, name) for name in ("Cem", "Dan"))
    for one, result in ((key, FOUND), (other, CLEAN)):
        take(season, one, [a_finding(40, result, on=BEGINS)], utc_now())
    page = phone.page
    for language, reads in (("en", "ltr"), ("he", "rtl")):
        page.goto("about:blank")
        page.goto(invitation(line.address, season.path.stem, key, str(BEGINS), language))
        page.locator(f"html[dir={reads}]").wait_for()
        page.locator(SENT).wait_for()
        page.goto(page.url.partition("#")[0])  # as from the home screen: the language stays
        page.locator(f"html[dir={reads}]").wait_for()
        _is_for_thumbs(page)
    page.locator("#open_menu").click()
    page.locator("fieldset").first.locator("button").first.click()  # the left hand
    page.locator("#close").click()
    clean, found = page.evaluate(LEFTS)
    assert clean < found, "under the left thumb"
    page.locator("#open_menu").click()
    page.evaluate(  # the other hand, and closed before that is kept
        "document.querySelectorAll('fieldset button')[1].click();"
        "document.getElementById('close').click(); document.getElementById('menu').id = 'old_menu'"
    )
    page.locator("#menu").wait_for(state="attached")
    assert not page.locator("#menu").evaluate("(menu) => menu.open")
    clean, found = page.evaluate(LEFTS)
    assert clean > found, "under the right thumb again"


#: where the two most pressed buttons begin
LEFTS = "['clean', 'found'].map((one) => document.getElementById(one).getBoundingClientRect().x)"


def _is_for_thumbs(page):
    """Hold all buttons to be large and on the screen, and the most pressed one to the right."""
    page.locator(SENT).wait_for()  # till then, the page may draw its buttons anew
    said = page.locator(".contradiction[data-plant='40']").inner_text()
    assert "Cem" in said
    assert "Dan" in said
    sizes = page.evaluate(
        "[...document.querySelectorAll('button')].filter((b) => b.offsetParent)"
        ".map((b) => [b.offsetWidth, b.offsetHeight, b.scrollWidth <= b.clientWidth + 1])"
    )
    assert all(width >= 56 and height >= 56 and fits for width, height, fits in sizes)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    clean, found = page.evaluate(LEFTS)
    assert clean > found, "under the right thumb"


def test_texts_that_do_harm_are_text_on_the_page_too(season, line, phone):
    """The plot's name, the scout's, what a photo is asked for and a note: all of the page's DOM."""
    season = hostile_season(season.path.parent / "Harm.gpkg")
    page, asked = phone.page, []
    page.on("request", lambda request: asked.append(request.url))
    plant = int(route_ahead(season, date(2026, 11, 17)).plant[0])
    ask_photo(season, plant, HARM)
    key = scouts.let_in(season, HARM[:60])
    page.goto(invitation(line.address, "Harm", key, "2026-11-17", "en"))
    page.locator("#clean").wait_for(timeout=120_000)
    _holds_texts_only(page)
    assert "Tue 17 Nov" in page.locator("#other_day").inner_text()
    page.locator("#open_menu").click()
    _holds_texts_only(page)
    page.keyboard.press("Escape")
    page.locator("#asked").click()
    page.locator(f"dialog [data-plant='{plant}']").click()
    page.locator(f"#place[data-plant='{plant}'] .asked", has_text="<script>").wait_for()
    page.locator("#note_button").click()
    page.locator("#notes").fill(HARM)
    page.locator("#ok").click()
    _holds_texts_only(page)
    told_now(page, "found", 2)
    _holds_texts_only(page)
    page.locator(SENT).wait_for(timeout=180_000)
    assert any(plant == row[1] for row in told(Season(season.path))[1])
    assert [url for url in asked if EVIL in url] == []


def _holds_texts_only(page):
    """Hold a page to elements and addresses of our own."""
    assert page.evaluate("window.hit") is None
    assert page.locator("body script, body iframe, [onerror]").count() == 0
    sources = page.evaluate(
        "[...document.querySelectorAll('[src], [href]')].map((e) => e.src || e.href)"
    )
    assert not [one for one in sources if EVIL in str(one) or str(one).endswith("/x")]
