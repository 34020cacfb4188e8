"""Two drives of one season at once are refused, and whatever ended one, the next may begin."""

import subprocess
import sys

import pytest

from fieldmon.drive.one_drive import one_drive
from fieldmon.errors import SettingError

_HOLDS = """
import sys
from pathlib import Path
from fieldmon.drive.one_drive import one_drive
with one_drive(Path(sys.argv[1]), "fieldmon/A"):
    print("holds", flush=True)
    sys.stdin.read()
"""


def test_a_season_is_driven_by_one_at_a_time_also_by_one_whose_process_was_killed(tmp_path):
    season, link = tmp_path / "season.gpkg", tmp_path / "link.gpkg"
    season.touch()
    link.symlink_to(season)
    words = [sys.executable, "-c", _HOLDS, str(season)]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as other:
        assert other.stdout.readline() == b"holds\n"
        for path in (season, link):
            with (
                pytest.raises(SettingError, match=r"but fieldmon/A drives (season|link)\.gpkg now"),
                one_drive(path, "fieldmon/B"),
            ):
                pass
        with one_drive(tmp_path / "other.gpkg", "fieldmon/B"):
            pass
        other.kill()
        other.wait()
    with one_drive(season, "fieldmon/B"):
        pass
    with one_drive(season, "fieldmon/B"):
        pass
