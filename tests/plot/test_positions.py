"""Positions are longitude and latitude, or refused in a sentence."""

import numpy as np
import pandas as pd
import pytest

from fieldmon.errors import ObservationError
from fieldmon.plot.positions import lonlat_of


def test_positions_are_in_degrees_longitude_first():
    assert lonlat_of("Plants", [[35.1, 30.3]]).tolist() == [[35.1, 30.3]]
    assert lonlat_of("Plants", []).shape == (0, 2)
    for bad in (
        [[30.0, 135.0]],
        [[np.nan, 30.0]],
        [[1e30, 0]],
        [35.1, 30.3],
        3.0,
        np.zeros((2, 3)),
    ):
        with pytest.raises(ObservationError, match=r"^Plants must be"):
            lonlat_of("Plants", bad)
    assert np.isnan(lonlat_of("Records", [[np.nan, np.nan]], nowhere=True)).all()


def test_a_table_that_calls_its_columns_lon_and_lat_may_have_them_in_any_order():
    table = pd.DataFrame({"n": [7], "Latitude": [30.3], "lon (deg)": [35.1]})
    wanted = [[35.1, 30.3]]
    assert lonlat_of("Plants", table).tolist() == wanted
    assert lonlat_of("Plants", pd.DataFrame({"lat": [30.3], "lon": [35.1]})).tolist() == wanted
    assert lonlat_of("Plants", pd.DataFrame(wanted)).tolist() == wanted
    with pytest.raises(ObservationError, match="pairs of longitude and latitude"):
        lonlat_of("Plants", table[["n", "lon (deg)", "n"]])
