"""What `fieldmon app` starts: a server that answers at once, while all else is still loading.

A browser takes longer to load Streamlit's page than Python takes to load Streamlit. So the page's
own files, which lie in Streamlit's folder, are handed out here; whatever else a browser asks for
waits for Streamlit, which runs as it does under any server (`st.App`).
"""

from __future__ import annotations

import asyncio
import logging
import mimetypes
import os
import re
import signal
import socket
import sys
import threading
import webbrowser
from concurrent.futures import ThreadPoolExecutor
from contextlib import AsyncExitStack
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fieldmon.errors import FieldmonError
from fieldmon.io.sandbox import process

from ..state import map_file, map_store, map_tiles, scout_page, web_maps
from . import addresses, gate, lan, preload
from .upload_limits import Uploads, is_upload

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    Message = dict[str, Any]
    Receive = Callable[[], Awaitable[Message]]
    Send = Callable[[Message], Awaitable[None]]
    Header = tuple[bytes, bytes]

#: what Streamlit is told through its own variables; all else is in .streamlit/config.toml
ADDRESS, PORT = "STREAMLIT_SERVER_ADDRESS", "STREAMLIT_SERVER_PORT"
PAGE = Path(__file__).resolve().parents[1] / "streamlit_app.py"
# without it the page asks for the server below its own address first: two errors a page; and who
# goes back is heard of by turning.js before Streamlit
_WHERE = b"""<head>
<script>window.__streamlit = {BACKEND_BASE_URL: new URL(".", location.href).href};
addEventListener("popstate", (event) => window.goesBack?.(event))</script>"""
_FOR_GOOD, _ASK = b"public, immutable, max-age=31536000", b"no-cache"
_OWN_FOR_GOOD = b"private, immutable, max-age=86400"
# Streamlit's page writes scripts and styles into itself, and charts are made of compiled text
_POLICY = (
    b"default-src 'self' data: blob:; script-src 'self' 'unsafe-inline' 'unsafe-eval' blob:; "
    b"style-src 'self' 'unsafe-inline'; connect-src 'self' data: blob: ws://HOST wss://HOST; "
    b"frame-ancestors 'self'; form-action 'self'; base-uri 'self'; object-src 'none'"
)
# one thread must not keep the others waiting while libraries load (Python's default is 5 ms)
_TURN_S = 0.0005
_GOODBYE_S = 5
# plain words that are Streamlit's own addresses
_STREAMLITS_OWN = frozenset({"/static", "/media", "/component", "/app", "/healthz"})
# as Python knows them: what a machine says of scripts may keep browsers from running them
_KINDS = mimetypes.MimeTypes()
# closed in by themselves, see there
_FOR_PHONES = (scout_page.PATH, "/api/")
# one reading process looks tiles up, one after the other: each takes a millisecond
# of an answer that a browser had
_NUMBER = re.compile(r"[0-9]{1,15}")
_TILES = ThreadPoolExecutor(1, "tiles")
_LOG = logging.getLogger(__name__)


class Server:
    """An ASGI application: the page's files at once, all else from Streamlit once it is loaded."""

    def __init__(self) -> None:
        self._files = page_files() | {map_file.ADDRESS: map_file.FILE}
        self._streamlit: Any = None
        self._loaded = asyncio.Event()
        self._names, self._uploads = addresses.own_names(), Uploads()

    async def __call__(self, scope: Message, receive: Receive, send: Send) -> None:
        """Answer a request, or run until the server stops."""
        if scope["type"] == "lifespan":
            await self._run(receive, send)
        elif not await self._refused(scope, receive, send):
            outside = scope["type"] == "http" and scope["path"].startswith(_FOR_PHONES)
            await (_answer_phone if outside else self._answer_browser)(scope, receive, send)

    async def _answer_browser(self, scope: Message, receive: Receive, send: Send) -> None:
        if scope["type"] == "http" and scope["path"].startswith(web_maps.PATH):
            await _hand_out_worker(scope["path"], send)
            return
        if scope["type"] == "http":
            send = _closed_in(send, scope)
        if is_upload(scope["path"]):
            await self._loaded.wait()
            await self._uploads.passed_on(self._streamlit, scope, receive, send)
        elif scope.get("method") == "GET" and is_page(scope["path"]):
            await self._hand_out("/", send)
        elif scope["path"] in self._files and scope.get("method") == "GET":
            await self._hand_out(scope["path"], send)
        elif scope["type"] == "http" and scope["path"].startswith(map_store.PATH):
            await _hand_out_map(scope, send)
        elif scope["type"] == "http" and scope["path"].startswith(map_tiles.PATH):
            await _hand_out_tile(scope["path"], send)
        else:
            await self._loaded.wait()
            await self._streamlit(scope, receive, send)

    async def _refused(self, scope: Message, receive: Receive, send: Send) -> bool:
        """Answer what is not to be answered; return whether it was that."""
        headers = list(scope.get("headers", ()))
        why, status = addresses.refusal(scope, headers, self._names), 403
        if why is None and scope["type"] == "http":
            why, status = self._uploads.refusal(scope["method"], scope["path"], headers), 413
        if why is None:
            return False
        if scope["type"] == "websocket":
            await receive()
            await send({"type": "websocket.close", "code": 1008, "reason": why[:120]})
        else:
            await _answer(send, status, "text/plain; charset=utf-8", why.encode(), [])
        return True

    async def _hand_out(self, path: str, send: Send) -> None:
        body = self._files[path].read_bytes()
        if path == "/":
            body = body.replace(b"<head>", _WHERE, 1)
        kind = _KINDS.guess_type(self._files[path].name)[0] or "application/octet-stream"
        lasting = path.startswith("/static/") or path == map_file.ADDRESS
        more = []
        if path == "/":
            # what draws maps is a megabyte of script, which the page asks for late: at its map
            more = [(b"link", f"<{map_file.ADDRESS}>; rel=modulepreload".encode())]
        await _answer(
            send, 200, kind, body, [(b"cache-control", _FOR_GOOD if lasting else _ASK), *more]
        )

    async def _run(self, receive: Receive, send: Send) -> None:
        """Load Streamlit beside the first answers; stop it at the end."""
        await receive()
        await send({"type": "lifespan.startup.complete"})
        async with AsyncExitStack() as stack:
            loading = asyncio.create_task(self._load(stack))
            await receive()
            await loading
        await send({"type": "lifespan.shutdown.complete"})

    async def _load(self, stack: AsyncExitStack) -> None:
        try:
            self._streamlit = await asyncio.to_thread(_streamlit)
            await stack.enter_async_context(self._streamlit.lifespan()(None))
        except Exception:  # noqa: BLE001 - nobody else would hear of it
            _LOG.exception("The app could not be loaded.")
            signal.raise_signal(signal.SIGINT)
            return
        self._loaded.set()
        preload.start()


def _closed_in(send: Send, scope: Message) -> Send:
    """Let a page fetch from this server only, and send to no other, whatever stands in it.

    It can still lead to another address (no policy of a browser forbids that), and the worker of a
    map that was agreed to asks that map's server.
    """
    host = dict(scope.get("headers", ())).get(b"host", b"")
    policy = _POLICY.replace(b"HOST", host) if addresses.is_host(host) else _POLICY

    async def send_closed_in(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = [*message.get("headers", ()), (b"content-security-policy", policy)]
            message = {**message, "headers": [*headers, (b"referrer-policy", b"same-origin")]}
        await send(message)

    return send_closed_in


async def _hand_out_map(scope: Message, send: Send) -> None:
    path = scope["path"]
    if (made := map_store.STORE.changing(path)) is not None:
        had = scope.get("query_string", b"").removeprefix(b"since=").decode("latin-1")
        now = await asyncio.to_thread(made, int(had) if _NUMBER.fullmatch(had) else None)
        await _answer(send, 200, map_store.JSON, now, [(b"cache-control", b"no-store")])
        return
    found = map_store.STORE.get(path)
    if found is None:
        await _answer(send, 404, "text/plain", b"", [(b"cache-control", b"no-store")])
        return
    await _answer(send, 200, *found, [(b"cache-control", _OWN_FOR_GOOD)])


async def _hand_out_worker(path: str, send: Send) -> None:
    """Hand out what may ask the server of a map that was agreed to, and nothing else."""
    if (policy := web_maps.ASKED.policy(path)) is None:
        await _answer(send, 404, "text/plain", b"", [(b"cache-control", b"no-store")])
        return
    guards = [
        (b"cache-control", _ASK),
        (b"content-security-policy", policy.encode()),
        (b"referrer-policy", b"same-origin"),
    ]
    await _answer(send, 200, "text/javascript", web_maps.WORKER.read_bytes(), guards)


async def _answer_phone(scope: Message, receive: Receive, send: Send) -> None:
    """Hand out the scout's page, or answer by the interface of a season."""
    if scope["path"].startswith(scout_page.PATH):
        await _hand_out_scout_page(scope, send)
    else:
        interface = await asyncio.to_thread(_interface)
        await interface(scope, receive, send)


async def _hand_out_scout_page(scope: Message, send: Send) -> None:
    """Hand out the page that works offline; it holds nothing of any season."""
    found = (await asyncio.to_thread(scout_page.files)).get(scope["path"])
    if found is None or scope["method"] not in {"GET", "HEAD"}:
        await _answer(send, 404, "text/plain", b"", [(b"cache-control", b"no-store")])
        return
    guards = [
        (b"cache-control", _ASK),
        (b"content-security-policy", scout_page.POLICY.encode()),
        (b"referrer-policy", b"no-referrer"),
        (b"cross-origin-resource-policy", b"same-origin"),
    ]
    await _answer(send, 200, found.kind, found.data, guards)


async def _hand_out_tile(path: str, send: Send) -> None:
    looked_up = asyncio.get_running_loop().run_in_executor(_TILES, map_tiles.SHELF.get, path)
    if (found := await looked_up) is None:
        # no picture there: the map knows, and need not ask again
        await _answer(send, 204, "text/plain", b"", [(b"cache-control", b"private, max-age=600")])
        return
    await _answer(send, 200, *found, [(b"cache-control", _OWN_FOR_GOOD)])


async def _answer(send: Send, status: int, kind: str, body: bytes, more: list[Header]) -> None:
    headers = [
        (b"content-type", kind.encode()),
        (b"content-length", b"%d" % len(body)),
        (b"x-content-type-options", b"nosniff"),
        *more,
    ]
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": body})


def page_files() -> dict[str, Path]:
    """Return the files of Streamlit's page by their addresses; nothing if they are elsewhere."""
    streamlit = find_spec("streamlit")
    if streamlit is None or streamlit.origin is None:
        return {}
    folder = Path(streamlit.origin).with_name("static")
    files = {f"/{f.relative_to(folder).as_posix()}": f for f in folder.rglob("*") if f.is_file()}
    if "/index.html" in files:
        files["/"] = files.pop("/index.html")
    return files


def is_page(path: str) -> bool:
    """Return whether an address is one of a page: one plain word."""
    return re.fullmatch(r"/[a-z]+", path) is not None and path not in _STREAMLITS_OWN


def _interface() -> Any:  # noqa: ANN401 - an ASGI application
    from ..api import season_api  # noqa: PLC0415 - libraries that nobody waits for at the start

    return season_api.application()


def _streamlit() -> Any:  # noqa: ANN401 - half a second to import
    return import_module("streamlit.starlette").App(PAGE)


def _has_screen() -> bool:
    """Return whether a browser can show itself; in a terminal it would only be in the way."""
    screens = ("DISPLAY", "WAYLAND_DISPLAY")
    return not sys.platform.startswith("linux") or any(map(os.environ.get, screens))


def _as_reached() -> Any:  # noqa: ANN401 - an ASGI application
    """Return the app; behind a server that others reach it asks for a password."""
    address = os.environ.get(scout_page.ADDRESS)
    if not address:
        return Server()
    password = os.environ.get(lan.PASSWORD) or gate.new_password()
    lan.say_password(password, address)
    return gate.Gate(Server(), password)


def main() -> None:
    """Serve the app at the address and port of the environment; `--browser` opens it there."""
    sys.path.append(str(PAGE.parent))  # before any run: see `streamlit_app`
    address, port = os.environ[ADDRESS], int(os.environ[PORT])
    line = socket.create_server((address, port), backlog=2048)
    process.warm()
    if "--browser" in sys.argv and _has_screen():
        url = f"http://{address}:{port}"
        threading.Thread(target=webbrowser.open, args=(url,), daemon=True).start()
    import uvicorn  # noqa: PLC0415 - the browser starts meanwhile

    sys.setswitchinterval(_TURN_S)
    settings: dict[str, Any] = {
        "access_log": False, "log_level": "warning", "ws": "websockets-sansio", "lifespan": "on",
        "ws_per_message_deflate": False, "ws_ping_interval": 30, "ws_ping_timeout": 30,
        "timeout_graceful_shutdown": _GOODBYE_S,
    }  # fmt: skip
    if lan.LAN in os.environ:
        try:
            lan.serve(Server(), port, line, settings)
        except FieldmonError as error:
            sys.exit(f"Error: {error}")
    else:
        server = uvicorn.Server(uvicorn.Config(_as_reached(), **settings))
        logging.getLogger("uvicorn.access").disabled = True  # the settings have switched it on
        server.run(sockets=[line])


if __name__ == "__main__":
    main()
