import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from rcl_interfaces.msg import SetParametersResult
from std_msgs.msg import String


class P(Node):
    def __init__(self):
        super().__init__("p")
        self.declare_parameter("message_prefix", "Hello")
        self.declare_parameter("publish_rate", 1.0)
        self.declare_parameter("enabled", True)
        self.rate = self.get_parameter("publish_rate").value
        if self.rate <= 0:
            self.get_logger().error("publish_rate must be positive")
            self.rate = 1.0
        self.pub = self.create_publisher(String, "~/chatter", 10)
        self.n = 0
        self.timer = self.create_timer(1.0 / self.rate, self.tick)
        self.add_on_set_parameters_callback(self.check)

    def check(self, ps):
        for p in ps:
            if p.name == "publish_rate" and p.value <= 0:
                return SetParametersResult(successful=False, reason="publish_rate must be > 0")
        for p in ps:
            if p.name == "publish_rate":
                self.apply(p.value)
        return SetParametersResult(successful=True)

    def apply(self, r):
        self.destroy_timer(self.timer)
        self.timer = self.create_timer(1.0 / r, self.tick)

    def tick(self):
        if not self.get_parameter("enabled").value:
            return
        self.pub.publish(String(data=f"{self.get_parameter('message_prefix').value} {self.n}"))
        self.n += 1


def main():
    rclpy.init()
    n = P()
    try:
        rclpy.spin(n)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
