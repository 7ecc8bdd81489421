import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

TICK = 0.5


class ParameterizedPublisher(Node):
    """Counts how many messages are due, and sends them all twice a second."""

    def __init__(self):
        super().__init__("parameterized_publisher")
        self.declare_parameter("message_prefix", "Hello")
        self.declare_parameter("publish_rate", 1.0)
        self.declare_parameter("enabled", True)
        if self.get_parameter("publish_rate").value <= 0:
            self.get_logger().error("publish_rate must be greater than 0")
        self.publisher = self.create_publisher(String, "chatter", 10)
        self.due = 0.0
        self.count = 0
        self.timer = self.create_timer(TICK, self.send)
        self.add_on_set_parameters_callback(self.check)

    def check(self, parameters):
        for parameter in parameters:
            if parameter.name == "publish_rate" and parameter.value <= 0:
                return SetParametersResult(successful=False, reason="the rate must be greater than 0")
        return SetParametersResult(successful=True)

    def send(self):
        if not self.get_parameter("enabled").value:
            return
        self.due += TICK * self.get_parameter("publish_rate").value
        prefix = self.get_parameter("message_prefix").value
        while self.due >= 1:
            self.publisher.publish(String(data=f"{prefix} {self.count}"))
            self.count += 1
            self.due -= 1


def main():
    rclpy.init()
    node = ParameterizedPublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
