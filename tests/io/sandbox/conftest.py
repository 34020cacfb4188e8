"""A folder to unpack into."""

import pytest

from fieldmon.io.sandbox.workroom import Workroom


@pytest.fixture
def room(tmp_path):
    (tmp_path / "room").mkdir()
    return Workroom(tmp_path / "room")
