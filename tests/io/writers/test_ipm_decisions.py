"""Field observations as IPM Decisions' schema has them."""

import json
from datetime import date

import jsonschema
import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.io.writers.ipm_decisions import EppoCodes, field_observations, observations_json
from fieldmon.plot.local_clock import LocalClock
from tests.monitoring.seasons import a_plot

GRID = a_plot().grid
MITES = EppoCodes("TETRUR", "LYPES")
#: schema "Field observation", version 0.1, and the geometry it leads to (NIBIO 2020)
SCHEMA = {
    "type": "object",
    "additionalProperties": False,
    "required": ["location", "time", "pestEPPOCode", "cropEPPOCode"],
    "properties": {
        "location": {
            "type": "object",
            "required": ["type", "coordinates"],
            "properties": {
                "type": {"enum": ["Point"]},
                "coordinates": {"type": "array", "minItems": 2, "items": {"type": "number"}},
            },
        },
        "time": {
            "type": "string",
            "pattern": r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(Z|[+-]\d\d:\d\d)$",
        },
        "pestEPPOCode": {"type": "string"},
        "cropEPPOCode": {"type": "string"},
    },
}


def written(clock="Asia/Jerusalem"):
    seen = Inspections.of(
        np.array([3, 4, 5]), np.array([FOUND, CLEAN, SKIPPED]), np.datetime64("2026-04-06"),
        second=np.array([6.5 * 3600, np.nan, np.nan]), count=np.array([12.0, np.nan, np.nan]),
    )  # fmt: skip
    return field_observations(seen, GRID, LocalClock(clock), MITES)


def test_observations_are_valid_against_the_schema_and_counts_go_beside_them():
    whole = json.loads(observations_json(written(), written("Asia/Kolkata")))
    seen, counted = whole["fieldObservations"], whole["fieldObservationQuantifications"]
    for one in seen:
        jsonschema.validate(one, SCHEMA)
    assert len(seen) == len(counted) == 4
    assert counted[:2] == [{"infested": True, "pestCount": 12.0}, {"infested": False}]
    assert [one["time"] for one in seen] == [
        "2026-04-06T06:30:00+03:00", "2026-04-06T12:00:00+03:00",
        "2026-04-06T06:30:00+05:30", "2026-04-06T12:00:00+05:30",
    ]  # fmt: skip
    assert seen[0]["location"]["coordinates"] == pytest.approx(GRID.lonlat(np.array([3]))[0], 1e-9)


def test_an_offset_that_is_no_whole_minute_is_written_as_utc():
    seen = Inspections.of(np.array([3]), np.array([CLEAN]), np.datetime64(date(1890, 1, 1)))
    (one,) = field_observations(seen, GRID, LocalClock("Europe/Paris"), MITES)["fieldObservations"]
    assert one["time"] == "1890-01-01T11:50:39Z"


@pytest.mark.parametrize(
    ("pest", "crop"), [("", "LYPES"), ("mites", "LYPES"), ("TETRUR", "TOMATO")]
)
def test_what_is_no_eppo_code_is_refused(pest, crop):
    with pytest.raises(SettingError, match="must be an EPPO code"):
        EppoCodes(pest, crop)
