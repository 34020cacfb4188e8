"""Archives made in memory, and what is said of those that are refused."""

import io
import zipfile

import pytest

from fieldmon.errors import FileProblem
from fieldmon.io.options import Upload
from fieldmon.io.sandbox.unpack import members

PLOTS = b'{"type": "FeatureCollection", "features": []}'
SHP = b"\x00\x00\x27\x0a" + bytes(96)


def zipped(contents, compression=zipfile.ZIP_DEFLATED):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", compression) as archive:
        for name, content in contents.items():
            archive.writestr(name, content)
    return data.getvalue()


def estate(**contents):
    return Upload("estate.zip", zipped(contents.pop("files", contents)))


def refused(source, room):
    with pytest.raises(FileProblem) as problem:
        [room.stage(member) for member in members(source, room)]
    return str(problem.value)
