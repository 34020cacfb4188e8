"""A day to hand off, for the tests of every format."""

import pytest

from tests.io.writers.handed import DAYS


@pytest.fixture(params=DAYS)
def plan(request):
    return DAYS[request.param]()
