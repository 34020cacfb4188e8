"""Options that commands share, and what is made of them."""

from pathlib import Path

import pytest

from fieldmon.cli.options import (
    Every,
    FileOptions,
    PlotFiles,
    RowOptions,
    refuse_idle_every,
    sampler_of,
    sampler_settings,
)
from fieldmon.errors import SettingError
from fieldmon.io.options import PlotOptions, ReadOptions, RecordOptions
from fieldmon.io.plot_request import PlantingChoices, PlotSources, RecordSource
from fieldmon.samplers import SAMPLERS


def test_rows_are_as_said_and_left_open_where_nothing_is():
    assert RowOptions().choices() == PlantingChoices()
    said = RowOptions(70.0, 4.0, 2.0, 3.0, both_faces=True).choices()
    assert said.given() == {
        "row_bearing_deg": 70.0,
        "row_spacing_m": 4.0,
        "plant_spacing_m": 2.0,
        "headland_m": 3.0,
        "faces": 2,
    }


def test_every_file_is_read_as_its_options_say():
    files = FileOptions(
        gate="35.15,30.36",
        plants=Path("p.shp"),
        paths=Path("w.shp"),
        crs="EPSG:2039",
        plot_option=["layer=parcels", "swap_axes=yes"],
        record_option=["date_order=mdy"],
        plants_option=["encoding=utf-8"],
        paths_option=["crs=EPSG:4326"],
    )
    request = PlotFiles(files=files).request(Path("e.zip"), "Gate", Path("r.csv"))
    assert request.sources == PlotSources(
        Path("e.zip"),
        PlotOptions(feature="Gate", crs="EPSG:2039", layer="parcels", swap_axes=True),
        Path("p.shp"),
        ReadOptions(encoding="utf-8"),
        Path("w.shp"),
        ReadOptions(crs="EPSG:4326"),
        (35.15, 30.36),
    )
    assert request.records == RecordSource(Path("r.csv"), RecordOptions(date_order="mdy"))
    assert (request.canopy, request.risk) == (None, None)


@pytest.mark.parametrize("gate", ["here", "1", "1,2,3"])
def test_a_gate_that_is_no_place_is_a_sentence(gate):
    with pytest.raises(SettingError, match="--gate must be LON,LAT"):
        FileOptions(gate=gate).sources(Path("e.zip"), None)


def test_a_command_without_any_plot_says_what_to_give():
    with pytest.raises(SettingError, match="--plants FILE"):
        FileOptions().sources(None, None)


def test_only_samplers_that_leave_plants_out_hear_of_every():
    assert sampler_settings("bouncy", 3) == {"every": 3}
    assert sampler_settings("random", None) == sampler_settings("naive", None) == {}
    assert sampler_of("bouncy", 3).every == 3
    refuse_idle_every(["naive", "bouncy"], 3)
    for name in ("adaptive", "naive", "my_sampler.py:Mine"):
        with pytest.raises(SettingError, match=f"--every goes with .*but this is {name}"):
            sampler_of(name, 3)


@pytest.mark.parametrize("role", ["plants", "paths", "rows", "contours", "blocks"])
def test_how_a_file_is_read_is_not_said_without_the_file(role):
    said = FileOptions(**{f"{role}_option": ["crs=EPSG:2039"]})
    with pytest.raises(SettingError, match=f"--{role}-option .* give it with --{role} FILE"):
        said.sources(Path("e.zip"), None)


def test_how_records_are_read_is_not_said_without_records():
    said = PlotFiles(files=FileOptions(record_option=["date_order=dmy"]))
    with pytest.raises(SettingError, match=r"--record-option .* give it with --records FILE"):
        said.request(Path("e.zip"), None, None)


@pytest.mark.parametrize(
    ("said", "told", "instead"),
    [
        ({"crs": "EPSG:25831"}, "--crs EPSG:25831", "--plants-option crs=EPSG:25831."),
        ({"layer": "plots"}, "--layer plots", "--plants-option layer=plots."),
        ({"plot_option": ["swap_axes=yes"]}, "--plot-option swap_axes=yes", "swap_axes=yes."),
    ],
)
def test_how_a_plot_file_is_read_is_not_said_without_one(said, told, instead):
    with pytest.raises(SettingError) as refused:
        FileOptions(plants=Path("p.csv"), **said).sources(None, None)
    assert str(refused.value).startswith(f"A plot file must be given for {told}, but none is.")
    assert str(refused.value).endswith(instead)


def test_the_help_of_every_names_each_sampler_that_takes_an_n_with_its_own():
    (told,) = Every.__metadata__
    having = [(name, kind) for name, kind in SAMPLERS.items() if kind.every is not None]
    assert having
    for name, kind in having:
        assert f"{name} {kind.every}" in told.help
    assert told.help.endswith(" or 1/N (random 3).")
