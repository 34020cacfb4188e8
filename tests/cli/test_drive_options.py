"""What a driven robot is called."""

import pytest

from fieldmon.cli.drive_options import DriveOptions, Drives
from fieldmon.errors import SettingError


def test_a_robot_is_called_by_its_maker_and_number_and_a_simulated_one_by_its_kind():
    assert [DriveOptions(robot=one).name for one in (Drives.CHARGED, Drives.MUJOCO)] == [
        "charged",
        "mujoco",
    ]
    live = DriveOptions(robot=Drives.VDA5050, serial="A")
    assert (live.name, live.robot_name().serial) == ("fieldmon/A", "A")


def test_a_version_that_no_robot_speaks_is_refused():
    with pytest.raises(SettingError, match=r"2\.1"):
        DriveOptions(vda="1.0").robot_name()
