"""Old Excel files (.xls), made byte by byte: nothing here writes them any more.

Sources: [MS-CFB] for the compound file, [MS-XLS] for the records in its stream ``Workbook``.
"""

import struct

_SECTOR = 512
_END, _FREE, _FAT = 0xFFFFFFFE, 0xFFFFFFFF, 0xFFFFFFFD


def xls(rows, sheet="Sheet1"):
    """Return an .xls with one sheet of numbers and text."""
    return _compound(_stream(rows, sheet))


def _record(kind, data=b""):
    return struct.pack("<HH", kind, len(data)) + data


def _text(text):
    wide = text.encode("utf-16-le")
    return struct.pack("<HB", len(wide) // 2, 1) + wide


def _stream(rows, sheet):
    begin = struct.pack("<HHHHII", 0x0600, 5, 0, 0, 0, 0)
    name = sheet.encode("utf-16-le")
    bound = struct.pack("<BB", len(name) // 2, 1) + name
    globals_size = len(_record(0x809, begin)) + len(_record(0x85, b"\0" * 6 + bound)) + 4
    book = _record(0x809, begin)
    book += _record(0x85, struct.pack("<IBB", globals_size, 0, 0) + bound) + _record(0x0A)
    book += _record(0x809, struct.pack("<HHHHII", 0x0600, 0x10, 0, 0, 0, 0))
    widest = max(map(len, rows))
    book += _record(0x200, struct.pack("<IIHHH", 0, len(rows), 0, widest, 0))
    for i, row in enumerate(rows):
        for j, value in enumerate(row):
            at = struct.pack("<HHH", i, j, 0)
            if isinstance(value, str):
                book += _record(0x204, at + _text(value))
            elif value is not None:
                book += _record(0x203, at + struct.pack("<d", value))
    return book + _record(0x0A)


def _compound(stream):
    stream = stream.ljust(4096, b"\0")  # a shorter one would lie in the small sectors
    stream = stream.ljust(-(-len(stream) // _SECTOR) * _SECTOR, b"\0")
    n = len(stream) // _SECTOR
    # sector 0 says what follows what, sector 1 is the directory, the stream comes behind
    follows = [_FAT, _END, *range(3, n + 2), _END]
    table = struct.pack(f"<{len(follows)}I", *follows).ljust(_SECTOR, b"\xff")
    root = _entry("Root Entry", 5, child=1, start=_END, size=0)
    directory = root + _entry("Workbook", 2, child=_FREE, start=2, size=len(stream))
    head = struct.pack(
        "<8s16sHHHHH6sIIIIIIIII",
        *(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", b"\0" * 16, 0x3E, 3, 0xFFFE, 9, 6, b"\0" * 6),
        *(0, 1, 1, 0, 4096, _END, 0, _END, 0),
    )
    head += struct.pack("<109I", 0, *[_FREE] * 108)
    return head + table + directory.ljust(_SECTOR, b"\0") + stream


def _entry(name, kind, child, start, size):
    wide = name.encode("utf-16-le")
    return struct.pack(
        "<64sHBBIII16sIQQIQ",
        *(wide, len(wide) + 2, kind, 1, _FREE, _FREE, child, b"\0" * 16, 0, 0, 0, start, size),
    )
