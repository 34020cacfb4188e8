"""A track notes ten places a second, and always the last."""

import numpy as np

from fieldmon.drive.track import Track


def test_ten_places_a_second_and_the_last_one():
    track = Track()
    for k in range(101):
        track.add(k * 0.01, k, 0.0, 0.0)
    assert len(track.poses) == 11
    track.add(1.05, 105.0, 0.0, 0.0)
    assert track.poses[-1].tolist() == [1.05, 105.0, 0.0, 0.0]
    assert (np.diff(track.poses[:, 0]) > 0).all()


def test_an_empty_track_has_no_places():
    assert Track().poses.shape == (0, 4)
