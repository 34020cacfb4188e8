"""Rows of two copies: each once, in the order of their recording, whatever the clocks said."""

import pytest

from fieldmon.monitoring.file import phone_tables, schema
from fieldmon.monitoring.merging import merged_rows, same_season


def test_every_table_of_a_season_is_merged_or_must_be_the_same_or_follows_from_them():
    follows = {schema.META, schema.DAYS, schema.PLANT_STATE, schema.HOT_SPOTS, schema.LEARNT}
    follows |= {schema.MORNINGS, schema.INSPECTION_LOTS}
    # what stays ours and is told of the other's
    logged = {schema.LOG}
    merged = {*same_season.SAME, *merged_rows.TAKEN, *logged, *phone_tables.TABLES}
    assert merged | follows == set(schema.TABLES)


@pytest.mark.parametrize(
    ("ours", "theirs", "together"),
    [
        ("1a 2b", "1a 2b", "1a 2b"),
        ("1a 3c", "1a 2b 4d", "1a 2b 3c 4d"),
        ("5a 1b", "5a 2c", "5a 1b 2c"),  # begun alike; a clock was set back
        ("5a 1b", "2c 6d", "2c 5a 1b 6d"),  # what stands below is later
    ],
)
def test_rows_stand_once_and_in_the_order_of_their_recording_either_way(ours, theirs, together):
    copies = [
        {"table": [{"at": at, "says": says} for at, says in told.split()]}
        for told in (ours, theirs)
    ]
    for both in (copies, copies[::-1]):
        rows = merged_rows.once(both, "table", ("at", "says"), "at")
        assert " ".join(row["at"] + row["says"] for row in rows) == together
