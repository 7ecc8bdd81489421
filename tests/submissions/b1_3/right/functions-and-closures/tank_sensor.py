import itertools
import random

import rclpy
from my_interfaces.msg import Reading
from my_interfaces.srv import InRange


def in_range(request, response):
    response.inside = not (request.value < request.low or request.value > request.high)
    return response


def main():
    rclpy.init()
    node = rclpy.create_node("tank")
    pub = node.create_publisher(Reading, "tank/reading", 10)
    count = itertools.count()

    def publish():
        msg = Reading()
        msg.header.stamp = node.get_clock().now().to_msg()
        msg.header.frame_id = str(next(count))
        msg.sensor, msg.unit, msg.value = "tank", "percent", random.uniform(0, 100)
        pub.publish(msg)

    node.create_timer(0.25, lambda: publish())
    node.create_service(InRange, "tank/in_range", in_range)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass
    rclpy.try_shutdown()


main()
