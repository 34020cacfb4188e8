"""Layers that hold plots, for the tests of what reads them."""

from shapely import box

from fieldmon.io.formats.layer import Layer
from fieldmon.io.options import PlotOptions
from tests.io.tables_of_cells import column, table

ANY = PlotOptions()
ONE, TWO, THREE = (box(5 + k, 45, 5.001 + k, 45.001) for k in range(3))


def layer_of(shapes, **columns):
    return Layer("estate", {k: column(v) for k, v in columns.items()}, column(shapes), "OGC:CRS84")


def names_of(imported):
    return [field.name for field in imported.value]


def corners(*lonlat, **more):
    lon, lat = zip(*lonlat, strict=True)
    return table(lon=list(lon), lat=list(lat), **more)


def square(i):
    return box(36 + i / 100, 30, 36.002 + i / 100, 30.002)
