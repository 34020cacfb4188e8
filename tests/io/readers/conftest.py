"""Weather tables of any text, read in Jerusalem unless it is told otherwise."""

from pathlib import Path
from tempfile import mkdtemp

import pytest

from fieldmon.io.options import Upload
from fieldmon.io.readers.weather import weather_in
from fieldmon.io.readers.weather_options import WeatherOptions
from fieldmon.io.sandbox.workroom import Workroom


@pytest.fixture
def read_weather(tmp_path):
    def _read(text, options=None, name="weather.csv"):
        data = text if isinstance(text, bytes) else text.encode()
        wanted = options or WeatherOptions(zone="Asia/Jerusalem")
        return weather_in(Upload(name, data), wanted, Workroom(Path(mkdtemp(dir=tmp_path))))

    return _read
