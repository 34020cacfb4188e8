"""What of a season's file says whether anything that counts was changed, and by whom."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from fieldmon.monitoring.changes.transactions import get_meta
from fieldmon.monitoring.file import schema

if TYPE_CHECKING:
    import sqlite3


class FileRevision(NamedTuple):
    """What changes when anything that counts does, whoever changed it.

    Parameters
    ----------
    changes
        How often the file was changed by us.
    inspections
        How often a row of the inspections was changed, by whomever.
    written
        A random name of our last change: a copy that was brought back, and changed as often since,
        has another one. Empty: an earlier version made it.
    """

    changes: int
    inspections: int
    written: str = ""

    @classmethod
    def of(cls, db: sqlite3.Connection) -> FileRevision:
        """Return what the file says of itself."""
        names = "revision", schema.INSPECTIONS_CHANGED, schema.WRITTEN
        # in one query: each reading of a season asks
        said = dict(db.execute("SELECT key, value FROM fieldmon WHERE key IN (?, ?, ?)", names))
        changes, inspections = (int(said.get(name) or 0) for name in names[:2])
        return cls(changes, inspections, str(said.get(names[2]) or ""))

    def once_kept(self, db: sqlite3.Connection) -> FileRevision:
        """Return what the file will say once the transaction that writes it is kept."""
        return FileRevision(self.changes + 1, self.inspections, get_meta(db, schema.COMES) or "")
