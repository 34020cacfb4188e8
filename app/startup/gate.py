"""Who may open the app from another device: whoever knows its password.

The scout's page holds nothing of a season and the interface of a season asks for a key: these two
stand outside the gate. No Streamlit in here.
"""

from __future__ import annotations

import hmac
import secrets
import time
from collections import OrderedDict, deque
from contextlib import suppress
from html import escape
from http.cookies import CookieError, SimpleCookie
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qs

from ..state import scout_page
from ..words import language, texts

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    Message = dict[str, Any]
    Receive = Callable[[], Awaitable[Message]]
    Send = Callable[[Message], Awaitable[None]]
    Application = Callable[[Message, Receive, Send], Awaitable[None]]

#: where the password goes
OPEN = "/_open"
_OUTSIDE = (scout_page.PATH, "/api/")
# without letters that are taken for others
_LETTERS = "abcdefghjkmnpqrstuvwxyz23456789"
_COOKIE = "__Host-fieldmon"
_MOST_BYTES = 4096
# of one address, and of all together: one device must not lock the others out
_TRIES, _TRIES_OF_ALL, _WITHIN_S = 10, 100, 60.0
_MOST_OPEN = 500
_POLICY = (
    b"default-src 'none'; style-src 'unsafe-inline'; form-action 'self'; frame-ancestors 'none'"
)
_HEADERS = [
    (b"cache-control", b"no-store"),
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"same-origin"),
    (b"content-security-policy", _POLICY),
]
STYLE = (
    "body{font:18px/1.5 system-ui,sans-serif;max-width:34rem;margin:2rem auto;padding:0 1rem;"
    "color:#111;background:#fff}input,button,.button{font:inherit;padding:.7rem 1rem;"
    "margin:.3rem 0;border:2px solid #333;border-radius:.6rem}"
    "button,.button{background:#1d5b2c;color:#fff;display:inline-block;text-decoration:none}"
    ".bad{color:#a00000}code{overflow-wrap:anywhere}"
    "@media(prefers-color-scheme:dark){body{color:#fff;background:#101214}.bad{color:"
    "#ff9d9d}input{background:#222;color:#fff}}"
)


def new_password() -> str:
    """Return a password of 59 random bits that can be read out."""
    return "-".join("".join(secrets.choice(_LETTERS) for _ in range(4)) for _ in range(3))


class Gate:
    """An ASGI application before another: it passes on who knows the password.

    Parameters
    ----------
    inside
        The app.
    password
        Whoever knows it may do all that the app does.
    """

    def __init__(self, inside: Application, password: str) -> None:
        self._inside, self._password = inside, password.encode()
        self._open: OrderedDict[str, None] = OrderedDict()
        # when, and from where: those under way and those that were wrong
        self._tries: deque[tuple[float, str]] = deque()

    async def __call__(self, scope: Message, receive: Receive, send: Send) -> None:
        """Pass a request on, or ask for the password."""
        if scope["type"] not in {"http", "websocket"} or scope["path"].startswith(_OUTSIDE):
            await self._inside(scope, receive, send)
        elif scope["type"] == "http" and scope["path"] == OPEN and scope["method"] == "POST":
            await self._ask(scope, receive, send)
        elif self._knows(scope) and (scope["type"] == "http" or not _is_foreign(scope)):
            await self._inside(scope, receive, send)
        elif scope["type"] == "websocket":
            await receive()
            await send({"type": "websocket.close", "code": 1008})
        else:
            await _said(scope, send, 401)

    async def _ask(self, scope: Message, receive: Receive, send: Send) -> None:
        """Take a password; too many wrong ones in a minute and none is taken."""
        if _is_foreign(scope):
            await _said(scope, send, 401, "wrong")
            return
        # counted before anything is waited for: tries at once are tries, too
        if (this := self._begun(scope)) is None:
            await _said(scope, send, 429, "wait")
            return
        if not hmac.compare_digest(await _password_of(receive), self._password):
            await _said(scope, send, 401, "wrong")
            return
        with suppress(ValueError):  # a minute may have passed
            self._tries.remove(this)
        token = secrets.token_urlsafe(32)
        self._open[token] = None
        while len(self._open) > _MOST_OPEN:
            self._open.popitem(last=False)
        cookie = f"{_COOKIE}={token}; Path=/; Secure; HttpOnly; SameSite=Lax"
        headers = [(b"location", b"/"), (b"set-cookie", cookie.encode()), *_HEADERS]
        await send({"type": "http.response.start", "status": 303, "headers": headers})
        await send({"type": "http.response.body", "body": b""})

    def _begun(self, scope: Message) -> tuple[float, str] | None:
        """Count a try; None if there were too many."""
        now, where = time.monotonic(), (scope.get("client") or ("",))[0]
        while self._tries and now - self._tries[0][0] >= _WITHIN_S:
            self._tries.popleft()
        own = sum(one == where for _, one in self._tries)
        if own >= _TRIES or len(self._tries) >= _TRIES_OF_ALL:
            return None
        self._tries.append((now, where))
        return now, where

    def _knows(self, scope: Message) -> bool:
        try:
            cookie = SimpleCookie(_header(scope, b"cookie")).get(_COOKIE)
        except CookieError:
            return False
        return cookie is not None and cookie.value in self._open


def language_of(scope: Message) -> str:
    """Return the language that a browser asks for, where the app speaks it."""
    for one in _header(scope, b"accept-language").split(","):
        if one.strip()[:2] in language.LANGUAGES:
            return one.strip()[:2]
    return language.ENGLISH


def page(title: str, body: str) -> bytes:
    """Return a small page that needs no script, in the session's language."""
    way = "rtl" if language.is_right_to_left() else "ltr"
    return (
        f'<!doctype html><html lang="{language.current()}" dir="{way}"><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(title)}</title><style>{STYLE}</style><main><h1>{escape(title)}</h1>"
        f"{body}</main></html>"
    ).encode()


async def _said(scope: Message, send: Send, status: int, problem: str = "") -> None:
    language.use(language_of(scope))
    words = texts.LAN_PAGE
    wrong = f'<p class="bad" role="alert">{escape(words[problem])}</p>' if problem else ""
    body = (
        f'{wrong}<form method="post" action="{OPEN}"><label>{escape(words["ask"])}<br>'
        '<input name="password" type="password" autocomplete="current-password" required autofocus>'
        f"</label><br><button>{escape(words['open'])}</button></form><p>{escape(words['where'])}</p>"
    )
    headers = [(b"content-type", b"text/html; charset=utf-8"), *_HEADERS]
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": page("fieldmon", body)})


async def _password_of(receive: Receive) -> bytes:
    body = b""
    while len(body) <= _MOST_BYTES:
        message = await receive()
        body += message.get("body", b"")
        if not message.get("more_body"):
            break
    sent = parse_qs(body[:_MOST_BYTES].decode("utf-8", "replace"))
    return sent.get("password", [""])[0].strip().encode()


def _is_foreign(scope: Message) -> bool:
    """Return whether another site's page asks."""
    origin = _header(scope, b"origin")
    return bool(origin) and origin.partition("://")[2] != _header(scope, b"host")


def _header(scope: Message, name: bytes) -> str:
    found = [value for key, value in scope.get("headers", ()) if key == name]
    return b"; ".join(found).decode("latin-1")
