"""Uploads are limited in number, bytes and time, for a window and for the machine."""

import asyncio
from contextlib import suppress

import pytest

from app.startup.upload_limits import UploadLimits, Uploads, is_upload
from tests.app.api.asking import in_own_loop

FEW = UploadLimits(files=3, megabytes=10, all_files=5, all_megabytes=15)


def sends(uploads, megabytes, window="a", method="PUT"):
    headers = [(b"content-length", str(int(megabytes * 1e6)).encode())]
    return uploads.refusal(method, f"/_stcore/upload_file/{window}/file", headers)


def test_a_window_may_send_so_many_files_and_no_more():
    uploads = Uploads(FEW)
    assert [sends(uploads, 1) for _ in range(3)] == [None] * 3
    assert "At most 3 files and 10 MB" in sends(uploads, 1)
    assert sends(uploads, 1, "b") is None


def test_a_window_may_send_so_many_bytes_and_what_is_refused_does_not_count():
    uploads = Uploads(FEW)
    assert sends(uploads, 8) is None
    assert "At most 3 files and 10 MB" in sends(uploads, 3)
    assert sends(uploads, 2) is None


def test_all_windows_together_may_not_fill_the_machine():
    uploads = Uploads(FEW)
    assert [sends(uploads, 7, window) for window in "ab"] == [None, None]
    assert "At most 5 files and 15 MB" in sends(uploads, 2, "c")
    assert sends(uploads, 1, "c") is None


def test_after_its_time_an_upload_counts_no_more():
    uploads = Uploads(UploadLimits(files=1, within_s=0.0))
    assert [sends(uploads, 1) for _ in range(3)] == [None] * 3


def test_an_upload_of_unknown_length_is_refused_and_what_is_no_upload_is_let_through():
    uploads = Uploads(FEW)
    path = "/_stcore/upload_file/a/b"
    assert "how long it is" in uploads.refusal("PUT", path, [(b"content-length", b"-1")])
    assert "how long it is" in uploads.refusal("POST", path, [])
    assert uploads.refusal("DELETE", path, []) is None
    assert uploads.refusal("GET", "/_stcore/health", []) is None
    assert (is_upload(path), is_upload("/_stcore/health")) == (True, False)


def test_an_upload_that_trickles_in_for_too_long_is_given_up():
    async def trickle():
        await asyncio.Event().wait()

    async def ask():
        return await Uploads(UploadLimits(seconds=0.01)).timed(trickle)()

    assert in_own_loop(ask) == {"type": "http.disconnect"}


def passed_on(uploads, status, method="PUT", megabytes=7.0):
    """Count an upload and let the app answer it; no status: its browser leaves."""
    assert sends(uploads, megabytes, method=method) is None

    async def app(_scope, _receive, send):
        if status is None:
            raise ConnectionError
        await send({"type": "http.response.start", "status": status})

    async def ask():
        async def nothing(*_):
            pass

        length = str(int(megabytes * 1e6)).encode()
        scope = {
            "path": "/_stcore/upload_file/a/file",
            "method": method,
            "headers": [(b"content-length", length)],
        }
        with suppress(ConnectionError):
            await uploads.passed_on(app, scope, nothing, nothing)

    in_own_loop(ask)


@pytest.mark.parametrize("status", [400, 403, 413, 500, None])
def test_what_the_app_did_not_take_does_not_count(status):
    uploads = Uploads(FEW)
    for _ in range(4):
        passed_on(uploads, status)
    passed_on(uploads, 405, method="POST")
    assert sends(uploads, 9) is None


def test_what_the_app_took_counts_also_if_it_is_taken_out_again_or_that_fails():
    uploads = Uploads(FEW)
    passed_on(uploads, 204)
    for status in (204, 403):
        passed_on(uploads, status, method="DELETE")
    assert "At most 3 files and 10 MB" in sends(uploads, 7)


def test_an_upload_in_chunks_is_refused_whatever_length_it_says():
    headers = [(b"content-length", b"1"), (b"transfer-encoding", b"chunked")]
    said = Uploads(FEW).refusal("PUT", "/_stcore/upload_file/a/b", headers)
    assert "how long it is" in said
