"""What a phone saved as not sent is read, and what is not as a phone writes it is left out."""

import base64
import json
import uuid

import pytest

from fieldmon.errors import FileProblem
from fieldmon.infestation.inspections import FOUND
from fieldmon.io.options import Upload
from fieldmon.io.read import read_phone_file
from fieldmon.io.readers.phone_file import is_phone_file

ID = str(uuid.UUID(int=1))
GOOD = {
    "id": ID, "at": "2026-04-06T06:00:00.123Z", "plant": 3, "result": "found", "count": 2,
    "stage": "", "leaves": None, "notes": "ב", "on": None, "off_route": False, "season": "gate",
    "who": "Ann",
}  # fmt: skip
PHOTO = {
    "id": str(uuid.UUID(int=2)), "finding": ID, "at": GOOD["at"], "type": "image/jpeg",
    "base64": base64.b64encode(b"\xff\xd8\xffx").decode(), "season": "gate", "who": "Ann",
}  # fmt: skip


def saved(findings=(), photos=(), **more):
    said = {"kind": "fieldmon findings", "findings": [*findings], "photos": [*photos]} | more
    return Upload("rescue.json", json.dumps(said).encode())


def test_findings_and_photos_come_out_as_they_were_told(tmp_path):
    file = tmp_path / "rescue.json"
    file.write_bytes(saved([GOOD], [PHOTO]).data)
    assert is_phone_file(file)
    read = read_phone_file(file)
    (one,), (photo,) = read.value.findings, read.value.photos
    assert read.messages == ()
    assert (one.season, one.who, one.fields["result"]) == ("gate", "Ann", FOUND)
    assert (one.fields["plant"], one.fields["notes"], one.fields["at"].year) == (3, "ב", 2026)
    assert (photo.fields["finding"], photo.fields["data"]) == (ID, b"\xff\xd8\xffx")


def test_what_a_finding_detects_is_read_and_what_is_no_chance_is_left_out_with_its_value():
    read = read_phone_file(saved([GOOD | {"detects": 0.3}, GOOD, GOOD | {"detects": 1.4}]))
    assert [one.fields["detects"] for one in read.value.findings] == [0.3, None]
    (said,) = read.messages
    assert said.feature == "finding 3"
    assert "must be above 0, and 1 at most, but it says 1.4" in said.sentence


def test_a_file_says_what_the_clock_said_and_one_from_before_does_not():
    clocks = {"clock": "2026-04-07T06:00:00.000Z", "time": "2026-04-06T06:00:00.000Z"}
    read = read_phone_file(saved([GOOD], saved=clocks)).value.of("gate").by("Ann")
    assert [at.day for at in read.clocks] == [7, 6]
    assert read_phone_file(saved([GOOD])).value.clocks is None
    with pytest.raises(FileProblem, match="not whole"):
        read_phone_file(saved([GOOD], saved=clocks | {"time": "noon"}))


def test_a_file_from_before_says_neither_season_nor_person():
    bare = {name: value for name, value in GOOD.items() if name not in {"season", "who"}}
    source = Upload("old.json", json.dumps({"findings": [bare], "photos": []}).encode())
    assert is_phone_file(source)
    (one,) = read_phone_file(source).value.findings
    assert (one.season, one.who) == ("", "")


@pytest.mark.parametrize(
    "wrong",
    [
        {"id": "1"}, {"id": None}, {"at": "now"}, {"at": "2026-04-06T06:00:00"}, {"at": 3},
        {"plant": -1}, {"plant": 1.5}, {"plant": True}, {"result": "maybe"}, {"count": "many"},
        {"count": -1}, {"lon": 181}, {"notes": "x" * 2001}, {"on": "2026-02-30"}, {"undoes": "x"},
        {"off_route": "no"}, {"who": 3}, {"after": "x"},
    ],
    ids=str,
)  # fmt: skip
def test_what_no_phone_writes_is_left_out_and_said(wrong):
    read = read_phone_file(saved([GOOD | wrong, GOOD]))
    assert len(read.value.findings) == 1
    (message,) = read.messages
    assert "not as a phone writes it" in str(message)


@pytest.mark.parametrize("data", [b"{", b'{"findings": 3, "photos": []}', b'{"findings": [}'])
def test_a_file_that_is_not_whole_is_refused(data):
    with pytest.raises(FileProblem):
        read_phone_file(Upload("rescue.json", data))


@pytest.mark.parametrize("data", [b"", b"a,b", b'{"type": "FeatureCollection"}', b"[1]"])
def test_other_files_are_none_of_a_phone(data):
    assert not is_phone_file(Upload("x.json", data))
