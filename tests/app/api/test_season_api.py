"""Who has a key of a season fetches its day and tells findings; a stranger learns nothing."""

import base64
import hashlib
import shutil
import sqlite3
import time
import uuid
from contextlib import closing

import pytest

from app.api import description, season_api
from app.api.season_api import application
from fieldmon.infestation.inspections import FOUND
from fieldmon.monitoring import Season
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.phones import photos, scouts
from tests.app.api.asking import Cut, as_sent, ask, exchange, in_own_loop, of_season, scope_of
from tests.monitoring.phone import JPEG, a_finding, told
from tests.monitoring.seasons import BEGINS

PHOTO = str(uuid.UUID(int=7))
ABOUT = f"finding={uuid.UUID(int=8)}&at=2026-04-06T06:00:00Z&lon=35.15&lat=30.36&accuracy_m=4"
#: every way in but the description, with what a person with a key would send
WAYS = {
    ("GET", "plot"): {},
    ("GET", "day"): {"query": "on=2026-04-06"},
    ("POST", "route"): {"body": {"on": "2026-04-06"}},
    ("POST", "findings"): {"body": as_sent(a_finding(3, on=BEGINS))},
    ("PUT", f"photos/{PHOTO}"): {"body": JPEG, "query": ABOUT},
    ("GET", f"photos/{PHOTO}"): {},
    ("PUT", f"photos_asked/{PHOTO}"): {"body": {"plant": 3, "note": "webs?"}},
    ("DELETE", f"photos_asked/{PHOTO}"): {},
}


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


@pytest.fixture
def _soon_refused(monkeypatch):
    """Answer strangers sooner: that all wait as long has a test of its own."""
    monkeypatch.setattr(season_api, "_REFUSED_S", 0.02)


def test_every_route_is_tried():
    ways = {(m, r.path) for r in application().routes for m in r.methods - {"HEAD"}}
    season = f"{description.PATH}/seasons/{{season}}"
    tried = {(m, f"{season}/{p.replace(PHOTO, '{photo}')}") for m, p in WAYS}
    assert ways == tried | {("GET", f"{description.PATH}/openapi.json")}


@pytest.mark.usefixtures("_soon_refused")
def test_with_a_key_every_way_is_open_until_it_ends(served):
    for (method, path), sent in WAYS.items():
        answer = ask(method, of_season(path), key=served.key, **sent)
        assert answer.status == 200, (method, path, answer.body)
        assert answer.headers["cache-control"] == "no-store"
        assert "access-control-allow-origin" not in answer.headers
    scouts.withdraw_key(served.season, "Ann")
    for (method, path), sent in WAYS.items():
        assert ask(method, of_season(path), key=served.key, **sent).status == 401, (method, path)


@pytest.mark.parametrize("trouble", ["held", "away", "folder away"])
def test_a_file_out_of_reach_for_a_moment_is_no_key_that_ended(served, trouble, monkeypatch):
    path = served.season.path
    if trouble == "held":
        monkeypatch.setattr(season_api, "_PATIENCE_S", 0.0)
        with closing(sqlite3.connect(path, isolation_level=None)) as other:
            for lock in ("EXCLUSIVE", "IMMEDIATE"):
                other.execute(f"BEGIN {lock}")
                sent = WAYS["POST", "findings"]
                answer = ask("POST", of_season("findings"), key=served.key, **sent)
                assert (answer.status, answer.json["cause"]) == (503, "held"), lock
                other.execute("ROLLBACK")
    elif trouble == "away":
        assert ask("GET", of_season("plot"), key=served.key).status == 200
        path.rename(path.with_name("away"))
        answer = ask("GET", of_season("plot"), key=served.key)
        path.with_name("away").rename(path)
    else:
        monkeypatch.setenv("FIELDMON_SEASONS", str(served.folder / "drive"))
        answer = ask("GET", of_season("plot"), key=served.key)
        monkeypatch.setenv("FIELDMON_SEASONS", str(served.folder))
    assert answer.status == 503
    assert "Try again later" in answer.json["error"]
    assert str(served.folder) not in answer.json["error"]
    assert ask("GET", of_season("plot"), key=served.key).status == 200


@pytest.mark.usefixtures("_soon_refused")
def test_a_stranger_reads_nothing_and_writes_nothing(served):
    other = Season(shutil.copy(served.season.path, served.folder / "other.gpkg"))
    ended = scouts.let_in(served.season, "Ben")
    scouts.withdraw_key(served.season, "Ben")
    before = digest(served.season.path)
    keys = {
        "none": "", "a guess": "a" * 24, "of another season": scouts.let_in(other, "Ann"),
        "taken back": ended, "a name": "season",
    }  # fmt: skip
    for (method, path), sent in WAYS.items():
        answers = [ask(method, of_season(path), key=key, **sent) for key in keys.values()]
        assert {answer.status for answer in answers} == {401}, (method, path)
        said = {answer.body for answer in answers}
        assert len(said) == 1, "what is answered does not tell one stranger from another"
        # nor does it tell which seasons there are
        for season in ("none", "..%2Fseason", "../season", "%00"):
            answer = ask(method, of_season(path, season), key=served.key, **sent)
            assert answer.status in {401, 404}
            assert (
                b"no key" in answer.body
                or b"there is none" in answer.body
                or (answer.status == 404)
            )
        assert digest(served.season.path) == before, (method, path)


def test_what_a_stranger_is_answered_does_not_tell_which_seasons_there_are(served):
    path = served.season.path
    for name in ("held", "wal", "away"):
        shutil.copy(path, served.folder / f"{name}.gpkg")
    key = scouts.let_in(Season(served.folder / "away.gpkg"), "Ann")
    assert ask("GET", of_season("plot", "away"), key=key).status == 200
    (served.folder / "away.gpkg").unlink()
    (served.folder / "damaged.gpkg").write_bytes(path.read_bytes()[:50_000])
    (served.folder / "noseason.gpkg").write_bytes(b"SQLite format 3\0" + bytes(4000))
    with (
        closing(sqlite3.connect(served.folder / "held.gpkg", isolation_level=None)) as other,
        closing(sqlite3.connect(served.folder / "wal.gpkg")) as qgis,
    ):
        qgis.execute("PRAGMA journal_mode = WAL")
        other.execute("BEGIN EXCLUSIVE")
        names = ["season", "nothing", "held", "wal", "away", "damaged", "noseason"]
        answers, took_s = [], []
        for name in names:
            began = time.monotonic()
            answers.append(ask("GET", of_season("plot", name), key="nonsense"))
            took_s.append(time.monotonic() - began)
    assert {answer.status for answer in answers} == {401}
    assert len({answer.body for answer in answers}) == 1
    assert min(took_s) >= season_api._REFUSED_S


def test_for_a_key_that_is_made_up_no_older_season_is_brought_up_to_date(served):
    with closing(sqlite3.connect(served.season.path)) as db:
        older = str(schema.VERSION - 1)
        db.execute("UPDATE fieldmon SET value = ? WHERE key = 'version'", (older,))
        db.commit()
    before, there = digest(served.season.path), sorted(served.folder.iterdir())
    assert ask("GET", of_season("plot"), key="nonsense").status == 401
    assert (digest(served.season.path), sorted(served.folder.iterdir())) == (before, there)
    assert ask("GET", of_season("plot"), key=served.key).status == 200
    assert digest(served.season.path) != before


@pytest.mark.parametrize(
    "headers",
    [{"origin": "https://elsewhere.example"}, {"origin": "null"}, {"sec_fetch_site": "cross-site"}],
    ids=["origin", "null", "fetch"],
)
def test_no_other_site_reads_or_writes_even_with_a_key(served, headers):
    own = {"origin": "http://127.0.0.1:8501", "sec_fetch_site": "same-origin"}
    for (method, path), sent in WAYS.items():
        before = digest(served.season.path)
        answer = ask(method, of_season(path), key=served.key, **sent, **headers)
        assert answer.status == 403, (method, path)
        assert not [name for name in answer.headers if name.startswith("access-control")]
        assert digest(served.season.path) == before
        assert ask(method, of_season(path), key=served.key, **sent, **own).status == 200


@pytest.mark.parametrize("path", ["findings", f"photos/{PHOTO}", "day"])
def test_a_browser_that_asks_whether_another_site_may_is_told_nothing(served, path):
    asks = {"origin": "https://elsewhere.example", "access_control_request_method": "PUT"}
    answer = ask("OPTIONS", of_season(path), key=served.key, **asks)
    assert answer.status == 405
    assert not [name for name in answer.headers if name.startswith("access-control")]


def test_findings_are_taken_once_and_what_is_answered_is_in_the_file(served):
    told_now = [a_finding(k, FOUND if k % 3 else 0, on=BEGINS) for k in range(20, 26)]
    for _ in range(3):
        answer = ask("POST", of_season("findings"), key=served.key, body=as_sent(*told_now))
        assert [one["id"] for one in answer.json["taken"]] == [one.id for one in told_now]
        assert {one["problem"] for one in answer.json["taken"]} == {""}
    assert sorted(told(Season(served.season.path))[0]) == sorted(one.id for one in told_now)
    day = ask("GET", of_season("day"), key=served.key, query="on=2026-04-06").json
    today = {(one["plant"], one["result"], one["who"]) for one in day["today"]}
    assert {(20, "found", "Ann"), (21, "clean", "Ann")} <= today
    assert not {one.plant for one in told_now} & {*day["route"]["plants"]}


def test_a_photo_comes_back_byte_for_byte(served):
    sent = {"key": served.key, "body": JPEG, "query": ABOUT}
    mark = base64.b64encode(hashlib.sha256(JPEG).digest()).decode()
    address = of_season(f"photos/{PHOTO}")
    assert ask("PUT", address, **sent, content_digest=f"sha-256=:{mark}:").json == {"new": True}
    assert ask("PUT", address, **sent).json == {"new": False}
    answer = ask("GET", address, key=served.key)
    assert (answer.body, answer.headers["content-type"]) == (JPEG, "image/jpeg")


def test_a_photo_is_asked_for_until_it_has_come(served):
    def asked():
        day = ask("GET", of_season("day"), key=served.key, query="on=2026-04-06").json
        return [(one["plant"], one["note"], one["who"]) for one in day["photos_asked"]]

    address, sent = of_season(f"photos_asked/{PHOTO}"), {"plant": 3, "note": "webs?"}
    for _ in range(2):  # an answer may be lost
        assert ask("PUT", address, key=served.key, body=sent).status == 200
    assert asked() == [(3, "webs?", "Ann")]
    other = ask("PUT", address, key=served.key, body={"plant": 4})
    assert (other.status, asked()) == (422, [(3, "webs?", "Ann")])
    assert ask("PUT", address, key=served.key, body={"plant": 10**6}).status == 422
    ask("PUT", of_season(f"photos/{PHOTO}"), key=served.key, body=JPEG, query=ABOUT)
    assert asked(), "a photo of a plant that nobody told yet"
    one = a_finding(3, id=str(uuid.UUID(int=8)), on=BEGINS)
    ask("POST", of_season("findings"), key=served.key, body=as_sent(one))
    assert asked() == []
    again = of_season(f"photos_asked/{uuid.UUID(int=9)}")
    ask("PUT", again, key=served.key, body=sent)
    assert len(asked()) == 1, "one that came before does not do"
    assert ask("DELETE", again, key=served.key).status == 200
    assert asked() == []


def test_what_did_not_arrive_as_it_was_sent_is_not_taken(served):
    address = of_season(f"photos/{PHOTO}")
    mark = base64.b64encode(hashlib.sha256(JPEG).digest()).decode()
    answer = ask("PUT", address, key=served.key, body=JPEG[:-1], query=ABOUT,
                 content_digest=f"sha-256=:{mark}:")  # fmt: skip
    assert answer.status == 422
    assert ask("GET", address, key=served.key).status == 404


@pytest.mark.parametrize("after", [0, 1, 2])
def test_a_line_cut_in_mid_body_takes_nothing(served, after):
    parts = [JPEG[:500], JPEG[500:1000], JPEG[1000:]]
    scope = scope_of("PUT", of_season(f"photos/{PHOTO}"),
                     {"authorization": f"Bearer {served.key}"}, ABOUT)  # fmt: skip
    answer = in_own_loop(lambda: exchange(application(), scope, parts, cut_after=after))
    assert answer.status == 499
    assert photos.picture(served.season, PHOTO) is None


@pytest.mark.parametrize("said", [True, False], ids=["said", "found out"])
def test_what_is_too_large_is_not_read_to_its_end(served, monkeypatch, said):
    monkeypatch.setattr(photos, "MOST_BYTES", 1000)
    headers = {"authorization": f"Bearer {served.key}"} | (
        {"content-length": "5000000000"} if said else {}
    )
    scope = scope_of("PUT", of_season(f"photos/{PHOTO}"), headers, ABOUT)
    read = []

    class Parts(list):
        def pop(self, at):
            read.append(1)
            return super().pop(at)

    many = Parts([b"x" * 600] * 50)
    answer = in_own_loop(lambda: _exchange_lazily(scope, many))
    assert answer.status == 413
    assert len(read) == (0 if said else 2)


async def _exchange_lazily(scope, parts):
    sent = []

    async def receive():
        return {"type": "http.request", "body": parts.pop(0), "more_body": True}

    async def send(message):
        sent.append(message)

    await application()(scope, receive, send)
    return type("Said", (), {"status": sent[0]["status"]})


@pytest.mark.usefixtures("served")
def test_the_description_is_there_for_everybody_and_says_no_season():
    answer = ask("GET", f"{description.PATH}/openapi.json")
    assert answer.status == 200
    assert answer.json["openapi"] == "3.1.0"
    assert b"Paran" not in answer.body


@pytest.mark.parametrize("path", ["/api", "/api/v1", "/api/v1/seasons", "/api/v2/x"])
def test_there_is_nothing_else(served, path):
    assert ask("GET", path, key=served.key).status == 404


def test_what_goes_wrong_here_is_a_sentence_and_may_be_tried_again(served, monkeypatch):
    def broken(*_):
        raise RuntimeError("secret")

    monkeypatch.setattr(season_api.documents, "day_document", broken)
    answer = ask("GET", of_season("day"), key=served.key)
    assert answer.status == 500
    assert "secret" not in answer.json["error"]


def test_the_helper_notices_a_line_cut():
    async def silent(*_):
        pass

    with pytest.raises(Cut):
        in_own_loop(lambda: exchange(silent, {}, [b""]))
