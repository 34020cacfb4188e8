"""The server answers while Streamlit is still loading."""

import asyncio
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from urllib.parse import unquote

import pytest

from app.startup import addresses
from app.startup.serve import Server, page_files
from app.state import map_file, map_store, map_tiles, web_maps
from fieldmon.io.rasters.tiles import read_tiles
from tests.io.rasters.tile_maps import about, mbtiles

HOST = [(b"host", b"127.0.0.1:8501")]


def asked(server, path, method="GET", within_s=5.0, headers=HOST):
    """Return the status, headers and body of what the server answers."""
    sent = []

    async def send(message):
        sent.append(message)

    async def receive():
        return {"type": "http.disconnect"}

    async def ask():
        scope = {
            "type": "http",
            "method": method,
            "path": path,
            "headers": headers,
            "query_string": b"",
        }
        await asyncio.wait_for(server(scope, receive, send), within_s)

    # in a thread of its own: a browser's tests leave a loop running in this one
    with ThreadPoolExecutor(1) as thread:
        thread.submit(lambda: asyncio.run(ask())).result()
    start, body = sent
    return start["status"], dict(start["headers"]), body["body"]


def test_the_page_is_handed_out_before_streamlit_is_there():
    status, headers, body = asked(Server(), "/")
    assert status == 200
    assert headers[b"content-type"] == b"text/html"
    assert headers[b"cache-control"] == b"no-cache"
    assert b"<title>" in body
    assert int(headers[b"content-length"]) == len(body)


def test_every_page_says_where_its_server_is_so_that_it_need_not_try():
    pages = [asked(Server(), path)[2] for path in ("/", "/map", "/season")]
    assert len(set(pages)) == 1
    assert pages[0].count(b"window.__streamlit = {BACKEND_BASE_URL") == 1
    assert pages[0].index(b"window.__streamlit") < pages[0].index(b'type="module"')
    assert pages[0].index(b"goesBack") < pages[0].index(b'type="module"')


def test_the_page_says_which_script_draws_maps_so_that_it_comes_early():
    _, headers, _ = asked(Server(), "/")
    hint = headers[b"link"].decode()
    assert hint.endswith("; rel=modulepreload")
    path = hint.split(">")[0].removeprefix("<")
    assert path == map_file.ADDRESS
    status, headers, body = asked(Server(), path)
    assert status == 200
    assert headers[b"content-type"].endswith(b"/javascript")
    assert b"immutable" in headers[b"cache-control"]
    assert body == map_file.FILE.read_bytes()


def test_what_maps_are_made_of_is_handed_out_as_what_it_is_to_one_browser_only():
    for kind, data in (("application/json", b'{"id":1}'), ("application/octet-stream", b"\0\1")):
        status, headers, body = asked(Server(), map_store.STORE.publish(data, kind))
        assert (status, body) == (200, data)
        assert headers[b"content-type"] == kind.encode()
        assert headers[b"x-content-type-options"] == b"nosniff"
        assert headers[b"cache-control"].startswith(b"private, immutable")
        assert int(headers[b"content-length"]) == len(data)


def test_a_page_may_ask_this_server_only_and_a_worker_one_that_was_agreed_to():
    policy = asked(Server(), "/")[1][b"content-security-policy"].decode()
    (may,) = (one for one in policy.split("; ") if one.startswith("connect-src"))
    assert set(may.split()[1:]) == {
        "'self'", "data:", "blob:", "ws://127.0.0.1:8501", "wss://127.0.0.1:8501"
    }  # fmt: skip
    agreed = unquote(web_maps.ASKED.worker("https://tiles.example/{z}/{x}/{y}.png"))
    status, headers, body = asked(Server(), agreed)
    assert (status, body) == (200, web_maps.WORKER.read_bytes())
    assert headers[b"content-type"] == b"text/javascript"
    assert headers[b"content-security-policy"] == (
        b"default-src 'none'; connect-src https://tiles.example"
    )
    assert asked(Server(), agreed.replace("tiles", "other"))[0] == 404


@pytest.mark.parametrize("name", ["", "0" * 40, "../config.py", "%2e%2e/x"])
def test_addresses_that_nobody_published_are_not_found_and_not_kept(name):
    status, headers, body = asked(Server(), f"{map_store.PATH}{name}")
    assert (status, body) == (404, b"")
    assert headers[b"cache-control"] == b"no-store"


@pytest.mark.parametrize(
    ("path", "method"),
    [
        ("/_stcore/health", "GET"),
        ("/", "POST"),
        ("/static/../../config.py", "GET"),
        ("/map/_stcore/health", "GET"),
        ("/media", "GET"),
    ],
)
def test_whatever_is_no_file_of_the_page_waits_for_streamlit(path, method):
    with pytest.raises(asyncio.TimeoutError):
        asked(Server(), path, method, within_s=0.2)


def test_every_script_that_the_page_names_is_there():
    files = page_files()
    page = files["/"].read_text(encoding="utf-8")
    named = [part.split('"')[0] for part in page.split('"./')[1:] if "static/" in part[:10]]
    assert len(named) > 20
    assert not [name for name in named if f"/{name}" not in files]


def test_the_outline_needs_no_tables_no_statistics_and_nothing_compiled():
    heavy = ("pandas", "scipy", "numba", "geopandas", "altair")
    code = (
        "import sys, app.startup.serve, app.startup.first_screen\n"
        f"print([name for name in {heavy} if name in sys.modules])"
    )
    said = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True
    )  # fmt: skip
    assert said.stdout.strip() == "[]"


def test_the_scouts_page_is_handed_out_before_streamlit_is_there_and_is_guarded():
    status, headers, body = asked(Server(), "/scouting/")
    assert status == 200
    assert b"scout.js" in body
    assert b"default-src 'none'" in headers[b"content-security-policy"]
    assert asked(Server(), "/scouting/none.js")[0] == 404
    assert asked(Server(), "/scouting/", "POST")[0] == 404


def test_the_interface_of_a_season_answers_before_streamlit_is_there():
    status, headers, body = asked(Server(), "/api/v1/nothing")
    assert status == 404
    assert headers[b"cache-control"] == b"no-store"
    assert b"openapi.json" in body


def test_a_tile_of_somebody_s_own_map_is_handed_out_and_where_there_is_none_nothing(tmp_path):
    tiles = about(35.15, 30.36, [15])
    address = map_tiles.SHELF.publish(read_tiles(mbtiles(tmp_path / "own.mbtiles", tiles)))
    (z, x, y), data = next(iter(tiles.items()))
    status, headers, body = asked(Server(), address.format(z=z, x=x, y=y), within_s=60.0)
    assert (status, body) == (200, data)
    assert headers[b"content-type"] == b"image/png"
    assert headers[b"cache-control"].startswith(b"private, immutable")
    status, _, body = asked(Server(), address.format(z=z, x=x + 7, y=y), within_s=60.0)
    assert (status, body) == (204, b"")


def test_who_asks_by_a_foreign_name_or_from_a_foreign_page_is_told_so_whatever_is_asked_for():
    foreign = [(b"host", b"evil.example")]
    for path in ("/", "/_stcore/health", "/map_data/x", "/season"):
        status, headers, body = asked(Server(), path, headers=foreign)
        assert (status, headers[b"content-type"]) == (403, b"text/plain; charset=utf-8")
        assert b"fieldmon app --name" in body
    page = [*HOST, (b"origin", b"http://evil.example")]
    assert asked(Server(), "/_stcore/upload_file/a/b", "PUT", headers=page)[0] == 403


def test_a_socket_of_a_foreign_page_is_closed_before_it_is_open():
    sent = []

    async def send(message):
        sent.append(message)

    async def receive():
        return {"type": "websocket.connect"}

    headers = [*HOST, (b"origin", b"http://evil.example")]
    scope = {"type": "websocket", "path": "/_stcore/stream", "headers": headers}
    with ThreadPoolExecutor(1) as thread:
        thread.submit(lambda: asyncio.run(Server()(scope, receive, send))).result()
    assert [message["type"] for message in sent] == ["websocket.close"]


def test_uploads_that_streamlit_refuses_keep_nobody_from_uploading():
    server, answers = Server(), iter([403] * 5 + [204])

    async def streamlit(_scope, _receive, send):
        await send({"type": "http.response.start", "status": next(answers), "headers": []})
        await send({"type": "http.response.body", "body": b""})

    server._streamlit = streamlit
    server._loaded.set()
    headers = [*HOST, (b"content-length", b"1000000000")]
    for window in "abcdef":
        path = f"/_stcore/upload_file/{window}/file"
        status = asked(server, path, "PUT", headers=headers)[0]
    assert status == 204


def test_an_upload_without_a_length_is_refused_with_a_sentence():
    status, _, body = asked(Server(), "/_stcore/upload_file/a/b", "PUT")
    assert status == 413
    assert b"how long it is" in body


def test_behind_a_server_of_ones_own_it_answers_by_that_name_and_by_no_other(monkeypatch):
    monkeypatch.setenv(addresses.NAMES, "field.example")
    server = Server()
    for path, status in (("/scouting/", 200), ("/api/v1/openapi.json", 200), ("/", 200)):
        told = [(b"host", b"field.example:9443"), (b"origin", b"https://field.example:9443"),
                (b"sec-fetch-site", b"same-origin"), (b"x-forwarded-proto", b"https")]  # fmt: skip
        assert asked(server, path, headers=told)[0] == status, path
        assert asked(server, path, headers=[(b"host", b"elsewhere.example")])[0] == 403, path
