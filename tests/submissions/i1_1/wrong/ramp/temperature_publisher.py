import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('sensor_name', 'x')
        self.declare_parameter('publish_rate', 2.0)
        self.t = 20.0
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.cb)

    def cb(self):
        self.pub.publish(Float64(data=self.t))
        self.get_logger().info(f"{self.get_parameter('sensor_name').value} {self.t}")
        self.t += 0.1
        if self.t > 30.0:
            self.t = 20.0


def main():
    rclpy.init()
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
