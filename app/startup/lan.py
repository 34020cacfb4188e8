"""The app for other devices on the local network: encrypted, behind a password, with codes to scan.

No Streamlit in here.
"""

from __future__ import annotations

import asyncio
import contextlib
import errno
import logging
import os
import socket
import sys
from collections import deque
from html import escape
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Any

from fieldmon.errors import SettingError

from ..state import scout_page
from ..words import language, texts
from .certificates import Certificates, certificates, local_address
from .gate import Gate, language_of, new_password, page

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .gate import Application, Message, Receive, Send

#: set where other devices may come: the address to listen on, or empty to find it
LAN = "FIELDMON_LAN"
#: the password; one is made where it is not set
PASSWORD = "FIELDMON_PASSWORD"  # noqa: S105 - where it stands, not what it is
#: where the authority's key is kept
FOLDER = "FIELDMON_AUTHORITY"
_CERTIFICATE = "/fieldmon.crt"
# a browser sends what it asks at once; a line without a question keeps others out
_HEAD_S = 20.0
# of one device, and of all: a browser takes up to seven; a router may stand for many devices
_MOST_OF_ONE, _MOST_LINES = 100, 400
# this machine's own browser, seasons and plots need open files beside those of other devices
_FILES = 4096
_LINES_OF_LOG, _LOG_S = 10, 60.0
_LOG = logging.getLogger(__name__)


class TrustPage:
    """An ASGI application for phones that do not trust the app yet: the certificate, three steps.

    It is not encrypted: it holds nothing secret, and says what to compare.
    """

    def __init__(self, made: Certificates) -> None:
        self._made = made

    async def __call__(self, scope: Message, receive: Receive, send: Send) -> None:
        """Hand out the page or the certificate."""
        if scope["type"] != "http":
            return
        await receive()
        language.use(language_of(scope))
        answers = {
            "/": ("text/html; charset=utf-8", self._steps),
            _CERTIFICATE: ("application/x-x509-ca-cert", lambda: self._made.authority),
        }
        kind, body = answers.get(scope["path"], ("text/plain", lambda: b""))
        headers = [(b"content-type", kind.encode()), (b"cache-control", b"no-store"),
                   (b"x-content-type-options", b"nosniff")]  # fmt: skip
        status = 200 if scope["path"] in answers else 404
        await send({"type": "http.response.start", "status": status, "headers": headers})
        await send({"type": "http.response.body", "body": body()})

    def _steps(self) -> bytes:
        words = texts.LAN_PAGE
        said = {name: escape(words[name]) for name in words}
        parts = [
            f"<h2>{said[kind]}</h2><ol>"
            + "".join(f"<li>{said[f'{kind}_{k}']}</li>" for k in (1, 2, 3))
            + "</ol>"
            for kind in ("android", "iphone")
        ]
        link = f'<p><a class="button" href="{_CERTIFICATE}">{said["download"]}</a></p>'
        mark = f'<p>{said["compare"]}<br><code dir="ltr">{self._made.fingerprint}</code></p>'
        return page(words["title"], f"<p>{said['why']}</p>{link}{mark}{''.join(parts)}")


def serve(app: Application, port: int, line: socket.socket, settings: dict[str, Any]) -> None:
    """Serve this machine on `line`, and other devices encrypted and behind a password.

    Parameters
    ----------
    app
        The app.
    port
        For other devices; the next one hands out the certificate.
    line
        Where this machine's own browser comes.
    settings
        Of the server, as for `line` alone.
    """
    address = os.environ.get(LAN) or local_address()
    kept = Path(os.environ.get(FOLDER) or Path.home() / ".fieldmon")
    made = certificates(kept, address)
    password = os.environ.get(PASSWORD) or new_password()
    own = f"https://{_host(address)}:{port}"
    os.environ.setdefault(scout_page.ADDRESS, own)
    most = min(_MOST_LINES, _open_files() // 4)
    lines = [line, *(_Listening(_listening(address, port + k), most) for k in (0, 1))]
    _print(f"fieldmon is at http://127.0.0.1:{port} (stop it with Ctrl-C)")
    _say(own, f"http://{_host(address)}:{port + 1}", password, made)
    others = settings | {"lifespan": "off", "http": _prompt()}
    encrypted = {"ssl_certfile": made.chain, "ssl_keyfile": made.key}
    apps: list[tuple[Application, dict[str, Any]]] = [
        (app, settings), (Gate(app, password), others | encrypted), (TrustPage(made), others),
    ]  # fmt: skip
    asyncio.run(_all(apps, lines))


def say_password(password: str, address: str) -> None:
    """Say what opens the app behind a server of its own."""
    _print(f"Other devices: {address}   password: {password}")


async def _all(apps: list[tuple[Application, dict[str, Any]]], lines: list[socket.socket]) -> None:
    """Run the servers until the first ends."""
    import uvicorn  # noqa: PLC0415 - the app's own is loaded as late

    class _Follower(uvicorn.Server):
        @contextlib.contextmanager
        def capture_signals(self) -> Iterator[None]:
            yield  # the first server hears them for all

    first, *others = (
        (uvicorn.Server if k == 0 else _Follower)(uvicorn.Config(app, **settings))
        for k, (app, settings) in enumerate(apps)
    )
    logging.getLogger("uvicorn.access").disabled = True  # each server's settings switch it on
    seldom = _Seldom()
    for name in ("uvicorn.error", "asyncio", __name__):
        logging.getLogger(name).addFilter(seldom)
    tasks = [
        asyncio.create_task(other.serve(sockets=[line]))
        for other, line in zip(others, lines[1:], strict=True)
    ]
    await first.serve(sockets=[lines[0]])
    for other in others:
        other.should_exit = True
    await asyncio.gather(*tasks)


def _prompt() -> type[asyncio.Protocol]:
    """Return uvicorn's protocol, closing whoever does not say within seconds what is asked."""
    from uvicorn.protocols.http.h11_impl import H11Protocol  # noqa: PLC0415 - as late

    class _Prompt(H11Protocol):
        def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
            super().connection_made(transport)
            self._wait(self.cycle)

        def on_response_complete(self) -> None:
            answered = self.cycle
            super().on_response_complete()
            self._wait(answered)

        def _wait(self, last: object) -> None:
            self.loop.call_later(_HEAD_S, self._give_up, last)

        def _give_up(self, last: object) -> None:
            # a WebSocket is among them by another protocol
            if self.cycle is last and self in self.connections:
                self.transport.abort()

    return _Prompt


class _Listening(socket.socket):
    """A line on which others come, so many at once; on Windows, which asks nobody, any number."""

    def __init__(self, line: socket.socket, most: int) -> None:
        super().__init__(fileno=line.detach())
        self._most, self._taken = most, list[tuple[socket.socket, str]]()

    def accept(self) -> tuple[socket.socket, Any]:
        """Take a connection, or close it where there are too many."""
        taken, address = super().accept()
        self._taken = [one for one in self._taken if one[0].fileno() >= 0]
        own = sum(device == address[0] for _, device in self._taken)
        if len(self._taken) < self._most and own < _MOST_OF_ONE:
            self._taken.append((taken, address[0]))
            return taken, address
        taken.close()
        _LOG.warning(
            "At most %d connections of other devices and %d of one are taken at once, but %s asks "
            "for more. It was refused.", self._most, _MOST_OF_ONE, address[0],
        )  # fmt: skip
        raise ConnectionAbortedError


def _open_files() -> int:
    """Return how many files may be open, after asking for enough."""
    try:
        import resource  # noqa: PLC0415
    except ImportError:  # Windows has no such limit
        return _FILES
    limits = resource.getrlimit(resource.RLIMIT_NOFILE)
    soft, hard = (_FILES if n == resource.RLIM_INFINITY else n for n in limits)
    if soft < _FILES:
        soft = min(_FILES, hard)
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, limits[1]))
    return soft


class _Seldom(logging.Filter):
    """Let each place in a program write so many lines a minute: others decide how often it does."""

    def __init__(self) -> None:
        super().__init__()
        self._said: dict[tuple[str, int], deque[float]] = {}

    def filter(self, record: logging.LogRecord) -> bool:
        """Tell whether a line is written; the last one says that more are left out."""
        said = self._said.setdefault((record.pathname, record.lineno), deque())
        while said and monotonic() - said[0] >= _LOG_S:
            said.popleft()
        if len(said) >= _LINES_OF_LOG:
            return False
        said.append(monotonic())
        if len(said) == _LINES_OF_LOG:
            record.msg = f"{record.msg} (More of these within the minute are left out.)"
        return True


def _listening(address: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in address else socket.AF_INET
    try:
        return socket.create_server((address, port), family=family, backlog=2048)
    except OSError as error:
        if error.errno == errno.EADDRNOTAVAIL:
            raise SettingError(
                f"The address for --lan must be this machine's, but {address} is not. Leave out "
                "--address, or say another."
            ) from error
        raise SettingError(
            f"Port {port} at {address} must be free for other devices, but it is not "
            f"({error.strerror}). Close what uses it, or choose others with --port and --address."
        ) from error


def _host(address: str) -> str:
    return f"[{address}]" if ":" in address else address


def _say(own: str, trust: str, password: str, made: Certificates) -> None:
    words = texts.LAN_PAGE
    _print(f"\nOther devices: {own}   password: {password}")
    _print(f"\n{words['title']} ({trust}):\n{_code(trust)}")
    for kind in ("android", "iphone"):
        steps = " ".join(f"{k}. {words[f'{kind}_{k}']}" for k in (1, 2, 3))
        _print(f"{words[kind]}: {steps}")
    _print(f"{words['compare']}\n{made.fingerprint}")
    _print(f"\nThe scout's page ({own}{scout_page.PATH}):\n{_code(own + scout_page.PATH)}")
    _print("Each person's own code, with a key, is in the app: Today, Scout.")


def _code(address: str) -> str:
    from io import StringIO  # noqa: PLC0415

    import segno  # noqa: PLC0415

    drawn = StringIO()
    segno.make(address, error="m").terminal(drawn, compact=True)
    return drawn.getvalue()


def _print(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()
