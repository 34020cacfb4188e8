"""Inside the reading process: pictures only, and files that are broken, as sentences."""

import sqlite3
from contextlib import closing

import pytest
from pmtiles.tile import TileType

from fieldmon.errors import FileProblem
from fieldmon.io.rasters import tile_files
from tests.io.rasters.tile_maps import about, mbtiles, picture, pmtiles

HERE = (35.151, 30.3604)


def test_the_side_of_a_tile_is_read_from_its_head():
    # a WebP that is lossy, without loss, and with more than a picture in it
    how = (("PNG", {}), ("JPEG", {}), ("WEBP", {}), ("WEBP", {"lossless": True}),
           ("WEBP", {"exif": b"Exif"}))  # fmt: skip
    for kind, options in how:
        for side in (256, 512):
            assert tile_files.side_of(picture((9, 9, 9), side, kind, **options)) == side


def test_maps_of_lines_instead_of_pictures_are_refused_and_never_handed_out(tmp_path):
    tiles = about(*HERE, [14], lambda *_: b"\x1f\x8b vector")
    mb = mbtiles(tmp_path / "v.mbtiles", tiles)
    pm = pmtiles(tmp_path / "v.pmtiles", tiles, (35, 30, 36, 31), TileType.MVT)
    for file in (mb, pm):
        with pytest.raises(FileProblem, match="must be pictures"):
            tile_files.described(str(file))
        assert tile_files.tile(str(file), *next(iter(tiles))) is None


@pytest.mark.parametrize("kept", [0, 20, 100, 130, 4000])
def test_a_file_that_is_cut_off_is_refused_with_a_sentence(tmp_path, kept):
    whole = pmtiles(tmp_path / "w.pmtiles", about(*HERE, [14]), (35, 30, 36, 31)).read_bytes()
    for name, data in (("c.pmtiles", whole), ("c.mbtiles", b"SQLite format 3\x00" + whole)):
        file = tmp_path / name
        file.write_bytes(data[:kept])
        if name == "c.pmtiles" and kept == 4000:
            assert tile_files.tile(str(file), 14, 3, 3) is None
            continue
        with pytest.raises(FileProblem, match="must be a map in tiles"):
            tile_files.described(str(file))


def test_a_geopackage_of_plots_is_no_map(tmp_path):
    with closing(sqlite3.connect(tmp_path / "p.gpkg")) as db, db:
        db.execute("CREATE TABLE plots (name TEXT)")
    with pytest.raises(FileProblem, match="must be a map in tiles"):
        tile_files.described(str(tmp_path / "p.gpkg"))


def test_an_empty_map_says_so(tmp_path):
    with pytest.raises(FileProblem, match="holds none"):
        tile_files.described(str(mbtiles(tmp_path / "e.mbtiles", {})))
