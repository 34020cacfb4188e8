"""Files that leave a choice are asked about; bad ones are a sentence."""

import pytest

from tests.app.driving import plot_name, press, square, upload, zipped


def test_a_missing_crs_is_asked_for_and_answered_by_button(app, tmp_path):
    data = zipped(tmp_path, square().to_crs(2039), without=".prj")
    upload(app, plot=("plot.zip", data))
    assert not app.exception
    assert "coordinate system" in app.warning[0].value
    ask = next(box for box in app.selectbox if box.label.endswith("crs"))
    assert "EPSG:2039" in ask.options
    ask.set_value("EPSG:2039").run()
    press(app, "Use this")
    assert not app.exception
    assert not app.warning
    assert plot_name(app) == "square"
    press(app, "Take back: crs = EPSG:2039")
    assert "coordinate system" in app.warning[0].value


@pytest.mark.parametrize(
    ("name", "data", "says"),
    [
        ("plot.zip", b"no zip", "plot"),
        ("plot.geojson", b"{}", "plot"),
        ("plot.csv", b"a,b\n1,2\n", "longitudes"),
    ],
)
def test_a_bad_file_is_a_sentence(app, name, data, says):
    upload(app, plot=(name, data))
    assert not app.exception
    assert any(says in message.value for message in [*app.error, *app.warning])
    assert app.file_uploader(key="plot_file")
