"""The simulated robot keeps the standard's rules for orders that come late, or twice."""

import ast

from fieldmon.drive.vda5050.messages import at_once, encoded, header_of
from fieldmon.drive.vda5050.stand_in import StandIn
from tests.drive.vda5050.conftest import ROBOT
from tests.paths import ROOT


def order(update, *places, first=0, name="o"):
    nodes = [
        {
            "nodeId": f"n{first + 2 * k}",
            "sequenceId": first + 2 * k,
            "released": True,
            "nodePosition": {"x": x, "y": 0.0, "mapId": "map"},
            "actions": [],
        }
        for k, x in enumerate(places)
    ]
    body = {"orderId": name, "orderUpdateId": update, "nodes": nodes, "edges": []}
    return encoded("order", header_of(*ROBOT), body)


def drive(robot, data):
    robot.wire.heard.put(("order", data))
    robot._hear()
    while robot.self.todo:
        robot._drive_on()


def test_orders_are_driven_once_and_in_their_order(broker):
    robot = StandIn(broker, ROBOT, lambda plant: False, speed_m_s=1.0, faster=1e9)  # noqa: ARG005
    drive(robot, order(0, 0.0, 10.0))
    assert (robot.self.place, robot.self.day_s) == ((10.0, 0.0), 10.0)
    drive(robot, order(0, 0.0, 10.0))  # twice
    assert robot.self.day_s == 10.0
    drive(robot, order(1, 10.0, 15.0, first=2))
    assert (robot.self.place, robot.self.day_s) == ((15.0, 0.0), 15.0)
    drive(robot, order(0, 0.0, 10.0))  # late
    assert robot.self.place == (15.0, 0.0)
    robot.wire.close()


def ask(robot, action, name):
    data = encoded("instantActions", header_of(*ROBOT), at_once(action, name))
    robot.wire.heard.put(("instantActions", data))
    robot._hear()
    return robot.self.at_once[name]["actionStatus"]


def test_another_order_is_refused_until_the_one_before_is_done_or_cancelled(broker):
    robot = StandIn(broker, ROBOT, lambda plant: False, speed_m_s=1.0, faster=1e9)  # noqa: ARG005
    refused = lambda: [one["errorType"] for one in robot.self.refusals]  # noqa: E731
    assert ask(robot, "cancelOrder", "c0") == "FAILED"
    assert refused() == ["noOrderToCancel"]
    for name in ("o", "p"):
        robot.wire.heard.put(("order", order(0, 0.0, 10.0, name=name)))
        robot._hear()
    assert (robot.self.order_id, refused()) == ("o", ["orderError"])
    assert ask(robot, "cancelOrder", "c1") == "FINISHED"
    assert robot.self.todo == []
    robot.wire.heard.put(("order", order(0, 0.0, 10.0, name="p")))
    robot._hear()
    assert (robot.self.order_id, refused()) == ("p", [])
    while robot.self.todo:
        robot._drive_on()
    assert robot.self.day_s == 10.0
    robot.wire.heard.put(("order", order(0, 10.0, 10.0, name="q")))
    robot._hear()
    assert robot.self.day_s == 0.0, "another order is of a day of its own"
    ask(robot, "cancelOrder", "c1")  # twice
    assert len(robot.self.todo) == 2
    robot.wire.close()


def test_a_robot_of_ones_own_says_how_it_drives(broker):
    """As the ROS 2 bridge of the documentation does."""
    been = []

    class Own(StandIn):
        def drive_to(self, there):
            been.append(there)

    robot = Own(broker, ROBOT, lambda plant: False)  # noqa: ARG005
    drive(robot, order(0, 0.0, 10.0, 12.0))
    assert been == [(10.0, 0.0), (12.0, 0.0)]
    robot.wire.close()


def test_the_ros_2_bridge_of_the_documentation_changes_what_is_there():
    tree = ast.parse((ROOT / "docs" / "examples" / "vda5050_ros2.py").read_text())
    (bridge,) = [one for one in tree.body if isinstance(one, ast.ClassDef)]
    assert [one.id for one in bridge.bases] == ["StandIn"]
    made = {one.name for one in bridge.body if isinstance(one, ast.FunctionDef)}
    assert made - {"__init__"} <= set(dir(StandIn))
