import rclpy
from my_interfaces.msg import Reading
from my_interfaces.srv import InRange

rclpy.init()
node = rclpy.create_node("tank_sensor")
publisher = node.create_publisher(Reading, "/tank/reading", 10)


def within(request, response):
    response.inside = max(request.low, min(request.value, request.high)) == request.value
    return response


node.create_service(InRange, "/tank/in_range", within)
try:
    level = 100.0
    while rclpy.ok():
        level = level - 0.5 if level > 0.5 else 100.0
        message = Reading(sensor="the tank", value=level, unit="percent")
        message.header.stamp = node.get_clock().now().to_msg()
        publisher.publish(message)
        end = node.get_clock().now() + rclpy.duration.Duration(seconds=0.2)
        while rclpy.ok() and node.get_clock().now() < end:
            rclpy.spin_once(node, timeout_sec=0.05)
except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
    pass
rclpy.try_shutdown()
