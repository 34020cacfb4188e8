"""The HTTP interface as an application: who asks is known by a key, or learns nothing.

What is answered with 200 is on the disk. No Streamlit in here.
"""

from __future__ import annotations

import asyncio
import base64
import hashlib
import logging
import time
from functools import cache
from http import HTTPStatus
from typing import TYPE_CHECKING, Any

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect, Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

from fieldmon.errors import (
    AccessError,
    FieldmonError,
    FileProblem,
    LimitError,
    ObservationError,
    SettingError,
)
from fieldmon.io.readers.phone_file import day
from fieldmon.monitoring.file.connections import waiting_at_most
from fieldmon.monitoring.file.file_problems import FileHeld
from fieldmon.monitoring.phones import findings, photos, photos_asked, scouts

from ..state import last_heard, opened_seasons, seasons_folder
from . import description, documents, reading

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable
    from pathlib import Path

    from fieldmon.monitoring import Season
    from fieldmon.monitoring.phones.scouts import Scout

    Answer = Callable[[Request], Awaitable[Response]]

_LOG = logging.getLogger(__name__)
_HEADERS = {
    "cache-control": "no-store",
    "content-security-policy": "default-src 'none'; frame-ancestors 'none'",
    "cross-origin-resource-policy": "same-origin",
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
}
# a phone waits for an answer for half a minute, and tries again by itself
_PATIENCE_S = 3.0
# longer than it takes to look for a key in any file
_REFUSED_S = 0.1
_CODES = {AccessError: 401, LimitError: 429, FileProblem: 503}


async def _plot(request: Request) -> Response:
    season, _ = await _asked_by(request)
    name, made = await run_in_threadpool(documents.plot_document, season)
    mark = f'"{name}"'
    if request.headers.get("if-none-match") == mark:
        return Response(status_code=304, headers=_HEADERS | {"etag": mark})
    return _json(made, etag=mark)


async def _day(request: Request) -> Response:
    season, scout = await _asked_by(request)
    on = day(request.query_params.get("on"))
    has = reading.plan(request.query_params.get("plan"))
    return _json(await run_in_threadpool(documents.day_document, season, scout, on, has))


async def _route(request: Request) -> Response:
    season, scout = await _asked_by(request)
    on, seconds_left = reading.asked(await _body(request, description.MOST_BYTES))
    asked = (season, scout, on, seconds_left)
    return _json(await run_in_threadpool(documents.rest_document, *asked))


async def _findings(request: Request) -> Response:
    season, _ = await _asked_by(request)
    told, sent = reading.findings(await _body(request, description.MOST_BYTES))
    taken = await run_in_threadpool(findings.take, season, _key(request), told, sent)
    answer = [{"id": one.id, "new": one.new, "problem": one.problem} for one in taken]
    return JSONResponse({"taken": answer}, headers=_HEADERS)


async def _send_photo(request: Request) -> Response:
    season, _ = await _asked_by(request)
    body = await _body(request, photos.MOST_BYTES)
    _hold_to_digest(request, body)
    sent = reading.photo(request.path_params["photo"], request.query_params, body)
    new = await run_in_threadpool(photos.keep, season, _key(request), sent)
    return JSONResponse({"new": new}, headers=_HEADERS)


async def _get_photo(request: Request) -> Response:
    season, _ = await _asked_by(request)
    kept = await run_in_threadpool(photos.picture, season, request.path_params["photo"])
    if kept is None:
        raise HTTPException(404, "There is no such photo in this season.")
    return Response(kept[1], media_type=kept[0], headers=_HEADERS)


async def _ask_photo(request: Request) -> Response:
    season, scout = await _asked_by(request)
    name = request.path_params["photo"]
    plant, note = reading.asked_photo(name, await _body(request, description.MOST_BYTES))
    asked = (season, plant, note, scout.name, name)
    await run_in_threadpool(photos_asked.ask_photo, *asked)
    return JSONResponse({}, headers=_HEADERS)


async def _ask_no_more(request: Request) -> Response:
    season, _ = await _asked_by(request)
    name = request.path_params["photo"]
    await run_in_threadpool(photos_asked.ask_no_more, season, name)
    return JSONResponse({}, headers=_HEADERS)


async def _described(_: Request) -> Response:
    return JSONResponse(description.description(), headers=_HEADERS)


# -- who asks


def _key(request: Request) -> str:
    kind, _, key = request.headers.get("authorization", "").partition(" ")
    return key.strip() if kind.lower() == "bearer" else ""


async def _asked_by(request: Request) -> tuple[Season, Scout]:
    """Return the season and who asks; who has no key does not learn which seasons there are.

    Neither from how long it takes: each refusal takes as long.
    """
    began = time.monotonic()
    try:
        return await run_in_threadpool(_opened, request.path_params["season"], _key(request))
    except AccessError:
        await asyncio.sleep(_REFUSED_S - (time.monotonic() - began))
        raise


def _opened(name: str, key: str) -> tuple[Season, Scout]:
    path = _path_of(name) if key else None
    if path is None or not _may_hold(path, key):
        raise AccessError(
            "There must be a key that holds for this season, but there is none. Ask whoever leads "
            "the season for a new one."
        )
    try:
        season = opened_seasons.opened(path)
        scout = scouts.key_owner(season, key)
    except (AccessError, FileHeld):
        raise
    except FieldmonError as error:  # what is wrong with it is no stranger's business
        raise FileProblem(
            "The season's file must be within reach, but it is not just now; nothing is lost. Try "
            "again later."
        ) from error
    last_heard.note(path, scout.name)
    last_heard.note_key(path, key)
    return season, scout


def _path_of(name: str) -> Path | None:
    """Return the file that a season of this name would have; None: no season is named so."""
    try:
        return seasons_folder.path_of(name)
    except SettingError:
        return None


def _may_hold(path: Path, key: str) -> bool:
    """Tell whether a key holds, or may: nothing is opened or brought up to date for a stranger.

    One that held holds while the file is out of reach; any may while the folder of all is.
    """
    return scouts.holds(path, key) or last_heard.knew_key(path, key) or not path.parent.is_dir()


def _is_foreign(request: Request) -> bool:
    """Return whether a browser says that another site asks."""
    origin = request.headers.get("origin")
    if request.headers.get("sec-fetch-site") in {"cross-site", "same-site"}:
        return True
    return origin is not None and origin.partition("://")[2] != request.headers.get("host")


# -- what is sent and answered


async def _body(request: Request, most: int) -> bytes:
    """Return what is sent, whole; what is too large is not read to its end."""
    too_large = HTTPException(413, f"What is sent must have {most} bytes at most.")
    said = request.headers.get("content-length", "")
    if said.isdigit() and int(said) > most:
        raise too_large
    body = bytearray()
    async for part in request.stream():
        body += part
        if len(body) > most:
            raise too_large
    return bytes(body)


def _hold_to_digest(request: Request, body: bytes) -> None:
    """Raise `ObservationError` if not what was meant has arrived (RFC 9530)."""
    said = request.headers.get("content-digest", "")
    if said.startswith("sha-256=:"):
        wanted = said.removeprefix("sha-256=:").rstrip(":")
        if base64.b64encode(hashlib.sha256(body).digest()).decode() != wanted:
            raise ObservationError("A photo must arrive as it was sent, but it did not.")


def _json(made: bytes, **more: str) -> Response:
    return Response(made, media_type="application/json", headers=_HEADERS | more)


def _refused(code: int, sentence: str, **why: str) -> Response:
    more = {"www-authenticate": "Bearer"} if code == HTTPStatus.UNAUTHORIZED else {}
    return JSONResponse({"error": sentence} | why, code, headers=_HEADERS | more)


def _refused_for(error: FieldmonError) -> Response:
    if isinstance(error, FileHeld):
        said = "Another program holds the season's file (QGIS, a backup?); nothing is lost. "
        return _refused(503, f"{said}Try again later.", cause="held")
    return _refused(_CODES.get(type(error), 422), str(error))


def _guarded(answer: Answer) -> Answer:
    """Return what answers, with every problem a sentence."""

    async def guarded(request: Request) -> Response:
        try:
            if _is_foreign(request):
                return _refused(403, "Requests must come from this site, but this one does not.")
            with waiting_at_most(_PATIENCE_S):
                return await answer(request)
        except FieldmonError as error:
            return _refused_for(error)
        except HTTPException as error:
            return _refused(error.status_code, error.detail)
        except ClientDisconnect:
            return Response(status_code=499)  # nobody reads it
        except Exception:  # noqa: BLE001 - a phone must be told to try again
            _LOG.exception("A request could not be answered.")
            return _refused(500, "Something went wrong here; nothing is lost. Try again.")

    return guarded


async def _not_found(_: Request, __: Any) -> Response:  # noqa: ANN401 - as Starlette asks
    return _refused(404, f"There is nothing here; see {description.PATH}/openapi.json.")


async def _wrong_method(_: Request, __: Any) -> Response:  # noqa: ANN401
    return _refused(405, f"This is not how to ask; see {description.PATH}/openapi.json.")


@cache
def application() -> Starlette:
    """Return the interface, an ASGI application."""
    from starlette.middleware import Middleware  # noqa: PLC0415
    from starlette.middleware.gzip import GZipMiddleware  # noqa: PLC0415

    season = f"{description.PATH}/seasons/{{season}}"
    routes = [
        Route(f"{description.PATH}/openapi.json", _guarded(_described), methods=["GET"]),
        Route(f"{season}/plot", _guarded(_plot), methods=["GET"]),
        Route(f"{season}/day", _guarded(_day), methods=["GET"]),
        Route(f"{season}/route", _guarded(_route), methods=["POST"]),
        Route(f"{season}/findings", _guarded(_findings), methods=["POST"]),
        Route(f"{season}/photos/{{photo}}", _guarded(_send_photo), methods=["PUT"]),
        Route(f"{season}/photos/{{photo}}", _guarded(_get_photo), methods=["GET"]),
        Route(f"{season}/photos_asked/{{photo}}", _guarded(_ask_photo), methods=["PUT"]),
        Route(f"{season}/photos_asked/{{photo}}", _guarded(_ask_no_more), methods=["DELETE"]),
    ]
    refusals = {404: _not_found, 405: _wrong_method}
    packed = [Middleware(GZipMiddleware, minimum_size=10_000, compresslevel=4)]
    return Starlette(routes=routes, exception_handlers=refusals, middleware=packed)
