"""Layouts name the topics that bags hold."""

import json

import yaml

from fieldmon.drive.bag import _TOPICS
from fieldmon.drive.bag_layouts import foxglove_layout, rviz_layout


def test_rviz_shows_topics_that_are_there():
    shown = yaml.safe_load(rviz_layout())["Visualization Manager"]
    topics = {one["Topic"]["Value"] for one in shown["Displays"] if "Topic" in one}
    assert topics == {"/plants", "/finds", "/plan"}
    assert topics <= _TOPICS.keys()
    assert shown["Global Options"]["Fixed Frame"] == "map"


def test_foxglove_shows_topics_that_are_there():
    layout = json.loads(foxglove_layout())
    assert layout["configById"]["3D!day"]["topics"].keys() <= _TOPICS.keys()
    assert {layout["layout"]["first"], layout["layout"]["second"]} == layout["configById"].keys()
