import contextlib

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Header

import my_interfaces.msg as msgs
import my_interfaces.srv


class Tank(Node):
    level = 0.0

    def __init__(self):
        super().__init__("tank")
        self.out = self.create_publisher(msgs.Reading, "/tank/reading", rclpy.qos.qos_profile_sensor_data)
        self.srv = self.create_service(my_interfaces.srv.InRange, "/tank/in_range", self.answer)
        self.timer = self.create_timer(0.1, self.tick)

    async def answer(self, request, response):
        response.inside = request.value in range(request.low, request.high + 1)
        return response

    def tick(self):
        self.level = (self.level + 1.5) % 100.0
        header = Header(stamp=self.get_clock().now().to_msg(), frame_id="tank")
        self.out.publish(msgs.Reading(header=header, sensor="t1", value=self.level, unit="percent"))


if __name__ == "__main__":
    rclpy.init()
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(Tank())
    rclpy.try_shutdown()
