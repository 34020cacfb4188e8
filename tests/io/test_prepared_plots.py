"""What comes of files says itself: who works on each plot, and how plants stand in their rows."""

from shapely import MultiLineString

from fieldmon.io.prepare import lay, prepare_estate
from fieldmon.plot.field import Field
from tests.io.three_parcels import FRAME, area, one
from tests.parcels import write_geojson


def test_crews_are_those_of_the_file(tmp_path):
    shapes = [area(0, 0), area(500, 0)]
    write_geojson(tmp_path / "p.geojson", shapes, robot=["scout", None], hours=[3.0, None])
    estate = prepare_estate(one(tmp_path / "p.geojson"))
    said = [(estate.crew(field).who, estate.crew(field).hours) for field in estate.fields]
    assert said == [("scout", 3.0), (None, None)]


def test_a_laid_plot_says_of_its_rows_what_is_known():
    laid = lay(Field("bare", area(0, 0)))
    assert laid.messages == ()
    assert {"row_spacing_m", "plant_spacing_m"} <= {one.setting for one in laid.assumed}
    drawn = MultiLineString([FRAME.lonlat([[5, y], [55, y]]) for y in (5, 10, 15)])
    (said_of_rows,) = lay(Field("drawn", area(0, 0), row_lines=drawn)).messages
    assert said_of_rows.line() == "seen: Plants stand along the 3 rows that were drawn."
