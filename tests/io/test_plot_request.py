"""What a plot is prepared from."""

from fieldmon.io.options import Upload
from fieldmon.io.plot_request import PlantingChoices, PlotRequest, PlotSources, RecordSource


def test_only_what_is_said_of_rows_is_given_on():
    assert PlantingChoices().given() == {}
    assert PlantingChoices(0.0, faces=2).given() == {"row_bearing_deg": 0.0, "faces": 2}


def test_the_same_request_is_the_same_key_and_another_another():
    def request(**more):
        records = RecordSource(Upload("r.csv", b"1"))
        return PlotRequest(PlotSources("p.zip", **more), PlantingChoices(70.0), records)

    assert request() == request()
    assert hash(request()) == hash(request())
    assert len({request(), request(), request(gate=(35.0, 30.0))}) == 2
