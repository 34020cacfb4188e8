"""One drive of a season at a time: two that know nothing of each other meet in an aisle."""

from __future__ import annotations

import hashlib
import os
import tempfile
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from fieldmon.errors import SettingError

try:
    import fcntl
except ImportError:  # Windows: nothing is held, and two are not noticed
    fcntl = None  # type: ignore[assignment]

if TYPE_CHECKING:
    from collections.abc import Iterator


@contextmanager
def one_drive(season: Path, name: str, *, is_team: bool = False) -> Iterator[None]:
    """Hold a season for a drive, as long as its process lives.

    Parameters
    ----------
    season
        The season's file.
    name
        Who drives.
    is_team
        Whether those are the robots of a team.

    Raises
    ------
    SettingError
        If another process, or another drive of this one, drives the season now.

    Examples
    --------
    >>> with one_drive(Path("season.gpkg"), "fieldmon/robot1"):
    ...     pass
    """
    held = -1 if fcntl is None else _held(season, name, is_team=is_team)
    try:
        yield
    finally:
        if held >= 0:
            os.close(held)


def _held(season: Path, name: str, *, is_team: bool) -> int:
    """Return what holds a season; -1 where nothing can be held."""
    told = hashlib.sha256(os.fsencode(season.resolve())).hexdigest()[:16]
    file = Path(tempfile.gettempdir()) / f"fieldmon-drives-{told}"
    held = -1
    with suppress(OSError):
        held = os.open(file, os.O_CREAT | os.O_RDWR | getattr(os, "O_NOFOLLOW", 0), 0o600)
    if held < 0:
        return held
    try:
        fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        other = os.read(held, 200).decode(errors="replace")
        os.close(held)
        instead = (
            "Wait for its end: one command drives all robots of the team."
            if is_team
            else "Wait for its end, or give the season a team (fieldmon change --robots), whose "
            "robots are driven at once."
        )
        raise SettingError(
            f"A season must be driven by one command at a time, but {other or 'another one'} "
            f"drives {season.name} now. {instead}"
        ) from None
    except OSError:
        return held
    os.ftruncate(held, 0)
    os.write(held, name.encode())
    return held
