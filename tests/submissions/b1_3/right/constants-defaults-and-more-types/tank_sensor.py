import rclpy
from my_interfaces.msg import Reading
from my_interfaces.srv import InRange
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class TankSensor(Node):
    def __init__(self):
        super().__init__("tank_sensor")
        self.value = Reading.LOWEST
        self.pub = self.create_publisher(Reading, "/tank/reading", 10)
        self.create_timer(0.2, self.publish)
        self.create_service(InRange, "/tank/in_range", self.in_range)

    def publish(self):
        self.value = min(Reading.HIGHEST, self.value + 1.0)
        reading = Reading(sensor="tank", value=self.value)
        reading.header.stamp = self.get_clock().now().to_msg()
        self.pub.publish(reading)

    def in_range(self, request, response):
        response.inside = sorted([request.low, request.value, request.high])[1] == request.value
        return response


def main():
    rclpy.init()
    try:
        rclpy.spin(TankSensor())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
