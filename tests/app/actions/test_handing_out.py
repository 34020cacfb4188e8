"""A day's route as a download: one file as it is, several as one archive."""

import io
import zipfile
from datetime import datetime

import pytest

from app.actions.handing_out import made
from fieldmon.io.writers import FORMATS, HandoffPlan
from fieldmon.io.writers.day_file import RouteNotes
from tests.app.chosen import a_plot, chosen


@pytest.fixture(scope="module")
def plan():
    route = chosen(a_plot()).plan().route
    return HandoffPlan(route, RouteNotes("square", "adaptive", datetime(2026, 11, 16, 6)))


@pytest.mark.parametrize("name", [name for name, one in FORMATS.items() if not one.several])
def test_one_file_is_handed_out_as_it_is(plan, name):
    (alone,) = FORMATS[name].make(plan).values()
    # archives hold the time at which they were made
    assert len(made(FORMATS[name], plan)) == len(alone)


def test_several_files_come_as_one_archive(plan):
    nav2 = FORMATS["nav2"]
    with zipfile.ZipFile(io.BytesIO(made(nav2, plan))) as archive:
        packed = {name.removeprefix("route"): archive.read(name) for name in archive.namelist()}
    assert packed == nav2.make(plan)
    assert len(packed) == 3
