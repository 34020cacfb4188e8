"""What is sent is read as described, or refused in a sentence that says what is wrong."""

import json
import uuid

import pytest

from app.api import reading
from fieldmon.errors import ObservationError
from tests.app.api.asking import as_sent
from tests.monitoring.phone import JPEG, NOW, a_finding

ID = str(uuid.UUID(int=1))
GOOD = {"id": ID, "at": "2026-04-06T06:00:00Z", "plant": 3, "result": "found"}


def sent(**changes):
    return json.dumps({"sent": "2026-04-06T06:00:00Z", "findings": [GOOD | changes]}).encode()


def test_what_a_phone_tells_comes_out_as_it_was_told():
    told = [a_finding(3, 1, count=4.0, notes="ב"), a_finding(None, None, undoes=ID)]
    read, at = reading.findings(json.dumps(as_sent(*told, sent=NOW)).encode())
    assert read == told
    assert at == NOW


@pytest.mark.parametrize(
    "wrong",
    [
        {"id": "1"}, {"id": ID.upper() + "x"}, {"at": "now"}, {"at": "2026-04-06T06:00:00"},
        {"at": "2026-13-06T06:00:00Z"}, {"at": "0001-01-01T00:00:00Z"}, {"plant": -1},
        {"plant": 1.5}, {"plant": 10**12}, {"plant": "3"}, {"result": "maybe"}, {"count": -1},
        {"lon": 181}, {"lat": -91}, {"notes": "x" * 2001}, {"on": "2026-02-30"}, {"more": 1},
        {"undoes": "x"}, {"leaves": "many"}, {"after": "now"}, {"known_at": "now"},
    ],
    ids=str,
)  # fmt: skip
def test_what_is_not_as_described_is_refused(wrong):
    with pytest.raises(ObservationError, match="must be"):
        reading.findings(sent(**wrong))


def test_a_plant_whose_number_is_written_with_a_point_is_whole():
    (read,), _ = reading.findings(sent(plant=3.0))
    assert (read.plant, type(read.plant)) == (3, int)
    plant, _ = reading.asked_photo(ID, b'{"plant": 3.0}')
    assert type(plant) is int


@pytest.mark.parametrize(
    "body", [b"", b"{", b"[]", b"null", b"\xff", b"[" * 100_000, sent(count=float("nan"))], ids=len
)
def test_what_is_no_json_is_refused(body):
    with pytest.raises(ObservationError):
        reading.findings(body)


def test_more_than_is_taken_at_once_is_refused():
    many = {"sent": GOOD["at"], "findings": [GOOD] * 501}
    with pytest.raises(ObservationError, match="findings"):
        reading.findings(json.dumps(many).encode())


def test_a_photos_address_says_what_it_is_of():
    query = {"finding": ID, "at": GOOD["at"], "lon": "35.1", "lat": "30.3", "accuracy_m": "4"}
    photo = reading.photo(ID, query, JPEG)
    assert (photo.finding, photo.lonlat, photo.accuracy_m) == (ID, (35.1, 30.3), 4.0)
    assert reading.photo(ID, {"finding": ID, "at": GOOD["at"]}, JPEG).lonlat is None


@pytest.mark.parametrize(
    "wrong",
    [
        {"finding": "x"},
        {"at": "x"},
        {"lon": "nan"},
        {"lat": "91"},
        {"accuracy_m": "x"},
        {"accuracy_m": "-5"},
    ],
)
def test_an_address_that_does_not_fit_is_refused(wrong):
    with pytest.raises(ObservationError):
        reading.photo(ID, {"finding": ID, "at": GOOD["at"]} | wrong, JPEG)
    with pytest.raises(ObservationError):
        reading.photo("../x", {"finding": ID, "at": GOOD["at"]}, JPEG)
    with pytest.raises(ObservationError, match="finding"):
        reading.photo(ID, {"at": GOOD["at"]}, JPEG)


def test_who_asks_for_the_rest_may_say_the_day_and_the_hours():
    assert reading.asked(b"") == (None, None)
    on, left = reading.asked(b'{"on": "2026-04-06", "seconds_left": 90}')
    assert (str(on), left) == ("2026-04-06", 90)


def test_a_clock_that_an_empty_battery_set_to_1970_is_read():
    (read,), _ = reading.findings(
        sent(at="1970-01-01T00:00:07.123Z", after=GOOD["at"], known_at=GOOD["at"])
    )
    assert (read.at.year, read.after.year, read.known_at.year) == (1970, 2026, 2026)
