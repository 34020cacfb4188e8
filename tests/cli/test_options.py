"""Options that commands share, and what is made of them."""

from pathlib import Path

import pytest

from fieldmon.cli.options import (
    FileOptions,
    PlotFiles,
    RowOptions,
    WorkerOptions,
    sampler_of,
    sampler_settings,
)
from fieldmon.cli.sampler_names import SamplerName
from fieldmon.errors import SettingError
from fieldmon.io.options import PlotOptions, ReadOptions, RecordOptions
from fieldmon.io.sources import PlantingChoices, PlotSources, RecordSource
from fieldmon.plot.robot import Robot, scout


def test_a_worker_is_the_robot_or_the_scout_but_for_what_is_said():
    assert WorkerOptions().robot() == Robot()
    assert WorkerOptions(scout=True).robot() == scout()
    said = WorkerOptions(hours=3.0, speed=7.2, turn=0.0).robot()
    assert (said.hours, said.speed_m_s, said.turn_180_s) == (3.0, 2.0, 0.0)
    assert said.look_s == Robot().look_s


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
    assert sampler_settings(SamplerName.BOUNCY, 3) == {"every": 3}
    assert sampler_settings(SamplerName.NAIVE, 3) == {}
    assert sampler_settings(SamplerName.RANDOM, None) == {}
    assert sampler_of(SamplerName.BOUNCY, 3).every == 3
    assert sampler_of(SamplerName.ADAPTIVE, 3) == sampler_of(SamplerName.ADAPTIVE, None)
