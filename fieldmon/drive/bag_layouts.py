"""How RViz and Foxglove show a bag: files that they open beside it."""

from __future__ import annotations

import json

_RVIZ = """\
Panels:
  - {Class: rviz_common/Displays, Name: Displays}
  - {Class: rviz_common/Time, Name: Time}
Visualization Manager:
  Class: ""
  Global Options: {Background Color: 240; 240; 235, Fixed Frame: map, Frame Rate: 15}
  Displays:
    - {Class: rviz_default_plugins/Grid, Name: Grid, Cell Size: 3, Plane Cell Count: 60,
       Color: 200; 200; 200, Enabled: true, Value: true}
    - {Class: rviz_default_plugins/MarkerArray, Name: Plants, Enabled: true, Value: true,
       Topic: {Value: /plants, Depth: 5, Durability Policy: Transient Local}}
    - {Class: rviz_default_plugins/MarkerArray, Name: Finds, Enabled: true, Value: true,
       Topic: {Value: /finds, Depth: 1000}}
    - {Class: rviz_default_plugins/Path, Name: Plan, Enabled: true, Value: true,
       Color: 0; 114; 178, Line Style: Billboards, Line Width: 0.15,
       Topic: {Value: /plan, Depth: 5}}
    - {Class: rviz_default_plugins/TF, Name: Robot, Enabled: true, Value: true,
       Marker Scale: 6, Frame Timeout: 100, Show Names: true}
  Tools:
    - {Class: rviz_default_plugins/MoveCamera}
    - {Class: rviz_default_plugins/Measure}
  Views:
    Current: {Class: rviz_default_plugins/Orbit, Distance: 60, Pitch: 0.9, Yaw: 4.2,
              Target Frame: base_link, Focal Point: {X: 0, Y: 0, Z: 0}}
Window Geometry: {Width: 1280, Height: 800, X: 0, Y: 0}
"""


def rviz_layout() -> bytes:
    """Return a layout that RViz opens with ``rviz2 -d``."""
    return _RVIZ.encode()


def foxglove_layout() -> bytes:
    """Return a layout that Foxglove and Lichtblick import."""
    topics = {name: {"visible": True} for name in ("/plants", "/finds", "/plan", "/tf")}
    layout = {
        "configById": {
            "3D!day": {
                "followTf": "base_link",
                "followMode": "follow-pose",
                "scene": {"labelScaleFactor": 0, "transforms": {"axisScale": 2}},
                "topics": topics,
                "cameraState": {"distance": 30, "phi": 55, "thetaOffset": 45, "perspective": True},
            },
            "map!day": {"topicColors": {}, "followTopic": "/gps/fix", "layer": "custom"},
        },
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": {"speed": 5},
        "layout": {"direction": "row", "first": "3D!day", "second": "map!day",
                   "splitPercentage": 70},
    }  # fmt: skip
    return json.dumps(layout, indent=1).encode()
