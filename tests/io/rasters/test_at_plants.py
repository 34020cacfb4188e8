"""What a raster says of each plant: its risk, and whether it is there."""

import numpy as np
import pytest
import rasterio

from fieldmon.errors import ChoiceNeeded, FileProblem, ObservationError
from fieldmon.infestation.prior.raster_risk import CHANCE_BAND, RiskSettings, risk_chance
from fieldmon.io.import_report import Severity
from fieldmon.io.options import Upload
from fieldmon.io.rasters.at_plants import read_missing, read_risk
from fieldmon.io.rasters.read import RasterOptions
from fieldmon.io.writers.chance_raster import write_chance_raster
from fieldmon.plot.plot import Plot
from tests.io.rasters.raster_files import PLOT, TO_UTM, corner, expected, ramp, write

ANY = RasterOptions()
HOME = Plot.of(PLOT)


def columns_of(plot):
    """Return the column of the raster in which each plant stands, of 400 of 1 m."""
    x, _ = TO_UTM.transform(*plot.grid.lonlat().T)
    return np.floor(x - corner()[0]).astype(int)


def test_the_risk_of_a_plant_is_that_of_its_own_ground(tmp_path):
    values = (ramp() / 1e6).astype("float32")
    path = write(tmp_path / "risk.tif", values)
    exact = read_risk(path, ANY, HOME, RiskSettings("chance"), "nearest").value
    np.testing.assert_allclose(exact, expected(HOME.grid.lonlat()) / 1e6, rtol=1e-5)
    # on a tilted plane the mean of the ground about a plant is that of its middle
    mean = read_risk(path, ANY, HOME, RiskSettings("chance")).value
    np.testing.assert_allclose(mean, exact, atol=0.0011)


def test_what_the_numbers_mean_is_as_said(tmp_path):
    path = write(tmp_path / "ndvi.tif", ramp())
    settings = RiskSettings("rank", mean_share=0.04, low_is_risky=True)
    imported = read_risk(path, ANY, HOME, settings)
    assert imported.value.mean() == pytest.approx(0.04)
    assert np.argmax(imported.value) == np.argmin(expected(HOME.grid.lonlat()))
    assert "Risk by rank" in imported.messages[-1].sentence
    with pytest.raises(ObservationError):
        risk_chance(expected(HOME.grid.lonlat()), RiskSettings("chance"))
    with pytest.raises(ObservationError):
        read_risk(path, ANY, HOME, RiskSettings("chance"))


def test_what_the_numbers_mean_is_asked_unless_the_file_says_it(tmp_path):
    path = write(tmp_path / "ndvi.tif", np.full((400, 400), 0.3, "float32"))
    with pytest.raises(ChoiceNeeded, match=r"0\.3 to 0\.3 at the plants") as asked:
        read_risk(path, ANY, HOME, None)
    assert asked.value.option == "meaning"
    assert asked.value.choices == ("rank", "score", "chance", "percent")
    with rasterio.open(path, "r+") as tif:
        tif.set_band_description(1, CHANCE_BAND)
    assert read_risk(path, ANY, HOME, None).value.mean() == pytest.approx(0.3)


def test_chances_that_have_much_of_the_plot_infested_are_doubted(tmp_path):
    much = write(tmp_path / "much.tif", np.full((400, 400), 0.5, "float32"))
    for settings, is_doubted in (
        (RiskSettings("chance"), True),
        (RiskSettings("percent"), False),
        (RiskSettings("rank", mean_share=0.5), False),  # somebody said it
    ):
        said = " ".join(map(str, read_risk(much, ANY, HOME, settings).messages))
        assert ("By it alone 50 % of all" in said) is is_doubted
        small = "All its percents are below 1" in said
        assert small is (settings.meaning == "percent")


def test_our_own_chance_map_has_a_value_at_every_plant_and_is_not_doubted(tmp_path):
    """It says nothing of the plot's rim, where no plant stands."""
    chance = np.linspace(0.01, 0.1, len(HOME.grid))
    write_chance_raster(HOME.grid, chance, tmp_path / "chance.tif")
    read = read_risk(tmp_path / "chance.tif", ANY, HOME, None, "nearest")
    assert [one.sentence for one in read.messages if one.severity is Severity.DOUBTFUL] == []
    np.testing.assert_allclose(read.value, chance, rtol=1e-5)


def half_without_value():
    values = np.full((400, 400), 15.0, "float32")
    values[:, 200:] = -1.0
    return values


def test_plants_that_the_raster_does_not_show_have_no_risk_by_it_and_are_counted(tmp_path):
    values = half_without_value()
    values[::2, :200] /= 2.0
    path = write(tmp_path / "risk.tif", values, nodata=-1.0)
    imported = read_risk(path, ANY, HOME, RiskSettings("percent"), "nearest")
    unseen = columns_of(HOME) >= 200
    np.testing.assert_array_equal(np.isnan(imported.value), unseen)
    assert 0 < unseen.sum() < len(unseen)
    assert imported.messages[-1].severity is Severity.SEEN
    wanted = f"{unseen.sum()} have no value on the raster and have no risk by it."
    assert imported.messages[-1].sentence.endswith(wanted)


def test_plants_without_canopy_are_missing_and_unseen_ones_count_as_there(tmp_path):
    values = half_without_value()
    values[:, :150] = 0.0
    path = write(tmp_path / "canopy.tif", values, nodata=-1.0)
    imported = read_missing(path, ANY, HOME, 0.2, "nearest")
    column = columns_of(HOME)
    np.testing.assert_array_equal(imported.value, column < 150)
    assert f"{(column < 150).sum()} of {HOME.n_plants} plants are missing" in (
        imported.messages[-1].sentence
    )


def test_one_leaf_on_its_ground_shows_that_a_plant_is_there(tmp_path):
    values = np.zeros((400, 400), "float32")
    x, y = TO_UTM.transform(*HOME.grid.lonlat(np.array([5]))[0])
    west, north = corner()
    values[int(north - y), int(x - west)] = 1.0
    path = write(tmp_path / "canopy.tif", values)
    missing = read_missing(path, ANY, HOME, 0.5).value
    assert not missing[5]
    assert missing.sum() > 0.9 * len(missing)


def test_a_raster_of_other_ground_is_refused(tmp_path):
    with pytest.raises(FileProblem):
        read_missing(Upload("r.tif", b"II*\x00"), ANY, HOME, 0.5)
    far = write(tmp_path / "far.tif", ramp(), crs="EPSG:32635")
    with pytest.raises(FileProblem):
        read_risk(far, ANY, HOME, RiskSettings("rank", mean_share=0.04))
