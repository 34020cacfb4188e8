"""What was assumed says so, with its unit."""

import pytest

from fieldmon.plot.assumed import Assumed


@pytest.mark.parametrize(
    ("one", "says"),
    [
        (Assumed("row_spacing_m", 4.0), "guessed: row spacing 4 m"),
        (Assumed("background_chance", 0.01), "guessed: chance of a plant of which nothing is"),
        (Assumed("rate_per_day", 0.02), "neighbour 2 %"),
        (Assumed("speed_m_s", 2.5 / 3.6), "speed 2.5 km/h"),
        (Assumed("treated", 1.0), "guessed: plants found infested are treated at once"),
    ],
)
def test_each_is_said_with_its_unit(one, says):
    assert says in str(one)
