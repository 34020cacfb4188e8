"""Behind the gate is whoever knows the password; outside it stand the page and the interface."""

import asyncio
import re

import pytest

from app.startup import gate
from app.startup.gate import OPEN, Gate, new_password
from tests.app.api.asking import exchange, in_own_loop, scope_of

PASSWORD = "abcd-efgh-jkmn"  # noqa: S105


class Inside:
    def __init__(self):
        self.asked = []

    async def __call__(self, scope, _, send):
        self.asked.append(scope["path"])
        if scope["type"] == "http":
            await send({"type": "http.response.start", "status": 200, "headers": []})
            await send({"type": "http.response.body", "body": b"inside"})


@pytest.fixture
def inside():
    return Inside()


@pytest.fixture
def door(inside):
    return Gate(inside, PASSWORD)


def ask(door, path, method="GET", body=b"", client="127.0.0.1", **headers):
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    scope = scope_of(method, path, named) | {"client": (client, 5000)}
    return in_own_loop(lambda: exchange(door, scope, [body]))


def opened(door, password=PASSWORD, **headers):
    return ask(door, OPEN, "POST", f"password={password}".encode(), **headers)


def cookie_of(answer):
    return re.match(r"[^;]+", answer.headers["set-cookie"])[0]


async def line(door, headers):
    """Return whether a WebSocket is passed on."""
    scope = scope_of("GET", "/_stcore/stream", headers) | {"type": "websocket"}
    said = []

    async def receive():
        return {"type": "websocket.connect"}

    async def send(message):
        said.append(message)

    await door(scope, receive, send)
    return said


@pytest.mark.parametrize(
    "path",
    ["/", "/season", "/static/js/x.js", "/map_data/x", "/_stcore/health", "/scouting", "/ap"],
)
def test_a_stranger_sees_nothing_of_the_app(door, inside, path):
    answer = ask(door, path)
    assert answer.status == 401
    assert b"password" in answer.body
    assert inside.asked == []
    assert in_own_loop(lambda: line(door, {})) == [{"type": "websocket.close", "code": 1008}]


@pytest.mark.parametrize("path", ["/scouting/", "/scouting/scout.js", "/api/v1/openapi.json"])
def test_what_keeps_its_own_door_stands_outside(door, path):
    assert ask(door, path).body == b"inside"


def test_the_password_opens_it_for_this_browser(door):
    answer = opened(door)
    assert (answer.status, answer.headers["location"]) == (303, "/")
    assert {"Secure", "HttpOnly", "SameSite=Lax", "Path=/"} <= {
        part.strip() for part in answer.headers["set-cookie"].split(";")
    }
    cookie = cookie_of(answer)
    assert ask(door, "/season", cookie=cookie).body == b"inside"
    assert (
        in_own_loop(lambda: line(door, {"cookie": cookie, "origin": "http://127.0.0.1:8501"})) == []
    )
    assert ask(door, "/", cookie=cookie[:-1] + "!").status == 401


def test_another_sites_page_opens_no_line_and_sends_no_password(door):
    cookie = cookie_of(opened(door))
    elsewhere = "https://elsewhere.example"
    assert in_own_loop(lambda: line(door, {"cookie": cookie, "origin": elsewhere}))
    assert {opened(door, origin=elsewhere).status for _ in range(11)} == {401}
    assert opened(door).status == 303, "a page elsewhere locks nobody out"


def test_guessing_ends_after_ten_tries(door):
    assert {opened(door, "wrong").status for _ in range(10)} == {401}
    assert opened(door, "wrong").status == 429
    assert opened(door).status == 429, "not even the right one: a guess must not be told from it"


def test_guesses_sent_all_at_once_are_counted_before_one_is_heard(door):
    heard = asyncio.Event()

    async def guess(word):
        sent = []

        async def receive():
            await heard.wait()
            return {"type": "http.request", "body": f"password={word}".encode()}

        async def send(message):
            sent.append(message)

        await door(scope_of("POST", OPEN, {}), receive, send)
        return sent[0]["status"]

    async def guesses():
        under_way = [asyncio.create_task(guess(word)) for word in [*"x" * 15, PASSWORD]]
        await asyncio.sleep(0)
        heard.set()
        return await asyncio.gather(*under_way)

    assert in_own_loop(guesses) == [401] * 10 + [429] * 6


def test_who_guesses_locks_nobody_else_out_but_all_together_guess_so_often_only(door):
    for _ in range(11):
        opened(door, "wrong", client="192.168.1.66")
    for _ in range(12):
        assert opened(door, client="192.168.1.20").status == 303
    for k in range(90):
        assert opened(door, "wrong", client=f"10.0.0.{k}").status == 401
    assert opened(door, client="192.168.1.20").status == 429


def test_a_minute_later_one_may_try_again(door, monkeypatch):
    for _ in range(11):
        opened(door, "wrong")
    now = gate.time.monotonic() + 61
    monkeypatch.setattr(gate.time, "monotonic", lambda: now)
    assert opened(door).status == 303


@pytest.mark.parametrize("body", [b"", b"password", b"x" * 100_000, b"password=\xff", b"pass=1"])
def test_what_is_no_password_opens_nothing(door, body):
    assert ask(door, OPEN, "POST", body).status == 401


def test_it_asks_in_the_browsers_language(door):
    answer = ask(door, "/", accept_language="he-IL,en;q=0.5")
    assert b'dir="rtl"' in answer.body
    assert "סיסמה".encode() in answer.body
    assert b'lang="en"' in ask(door, "/", accept_language="xx").body


def test_passwords_are_made_of_letters_that_can_be_read_out():
    made = {new_password() for _ in range(50)}
    assert len(made) == 50
    assert all(re.fullmatch(r"([a-hjkmnp-z2-9]{4}-?){3}", one) for one in made)
