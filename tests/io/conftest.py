"""What tests of files share."""

import pytest

from tests.io.three_parcels import area
from tests.parcels import write_geojson


@pytest.fixture
def parcels(tmp_path):
    """Return a file of three plots, half a kilometre apart, that states nothing about rows."""
    write_geojson(tmp_path / "parcels.geojson", [area(0, 0), area(500, 0, 40), area(0, 500, 50)])
    return tmp_path / "parcels.geojson"
