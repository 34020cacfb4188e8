"""A ROS 2 robot that takes orders by VDA 5050: Nav2 drives, a detector looks, fieldmon is asked.

To read and to change: ROS 2 is not on the machine of the tests, so this has not been run. Orders,
late and doubled messages, pauses and states are `StandIn`'s, which the tests do run.
"""

import time

import rclpy
from geometry_msgs.msg import PoseStamped
from nav2_simple_commander.robot_navigator import BasicNavigator, TaskResult

from fieldmon.drive.vda5050.mqtt import Broker, RobotName
from fieldmon.drive.vda5050.stand_in import StandIn


class NavigatingRobot(StandIn):
    """Drives with Nav2; the map's origin is the plot's centre, x east and y north (see routes)."""

    def __init__(self, broker, name, look):
        self.navigator, self.begun = BasicNavigator(), time.monotonic()
        super().__init__(broker, name, look)

    def drive_to(self, there):
        goal = PoseStamped()
        goal.header.frame_id = "map"
        goal.header.stamp = self.navigator.get_clock().now().to_msg()
        goal.pose.position.x, goal.pose.position.y = there
        goal.pose.orientation.w = 1.0
        self.navigator.goToPose(goal)
        while not self.navigator.isTaskComplete():
            time.sleep(0.1)
        if self.navigator.getResult() != TaskResult.SUCCEEDED:
            said = f"Nav2 did not reach {there}"
            self.self.errors = [
                {"errorType": "navigation", "errorLevel": "FATAL", "errorDescription": said}
            ]
        self.self.day_s = time.monotonic() - self.begun


def look(plant):
    """Say whether a plant is infested: True, False, or None where it could not be looked at."""
    raise NotImplementedError("your camera and detector")


if __name__ == "__main__":
    rclpy.init()
    NavigatingRobot(Broker.of("127.0.0.1:1883"), RobotName("fieldmon", "robot1"), look).run()
