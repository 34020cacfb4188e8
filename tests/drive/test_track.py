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


def test_what_is_far_from_the_last_place_is_noted_however_soon_it_comes():
    track = Track(far_m=0.5)
    for k in range(4):
        track.add(k * 0.01, 0.4 * k, 0.0, 0.0)
    assert track.poses[:, 1].round(1).tolist() == [0.0, 0.8, 1.2]


def test_an_empty_track_has_no_places():
    assert Track().poses.shape == (0, 4)


def test_when_the_robot_was_last_seen_is_known_without_all_its_places():
    track = Track()
    assert track.last_s == -np.inf
    for at_s in (0.0, 0.01, 0.1, 0.15):
        track.add(at_s, 0.0, 0.0, 0.0)
        assert track.last_s == track.poses[-1, 0] == at_s
