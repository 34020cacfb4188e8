"""Files zipped in memory: equal files make equal bytes, and who unpacks them may read them."""

from __future__ import annotations

import io
import zipfile
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

# the earliest that a zip can name
_EPOCH = (1980, 1, 1, 0, 0, 0)
_READABLE = 0o644 << 16


def zipped(files: Mapping[str, bytes]) -> bytes:
    """Return files, by their names, as one zip.

    Examples
    --------
    >>> zipped({"a.txt": b"one"}) == zipped({"a.txt": b"one"})
    True
    """
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for name, data in files.items():
            info = zipfile.ZipInfo(name, _EPOCH)
            info.external_attr = _READABLE
            archive.writestr(info, data, zipfile.ZIP_DEFLATED)
    return packed.getvalue()


def zipped_folder(folder: Path) -> bytes:
    """Return the files of a folder as one zip, in the order of their names."""
    return zipped({part.name: part.read_bytes() for part in sorted(folder.iterdir())})
