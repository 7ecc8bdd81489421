import random

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Float64, String
from std_srvs.srv import Trigger


class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        self.declare_parameter('frame_id', 'base_link')
        self.declare_parameter('history_depth', 10)
        self.declare_parameter('max_temp', 30.0)
        self.declare_parameter('min_temp', 20.0)
        self.declare_parameter('publish_rate', 2.0)
        self.declare_parameter('sensor_name', 'boiler')
        self.declare_parameter('units', 'C')
        self.low = self.get_parameter('min_temp').value
        self.high = self.get_parameter('max_temp').value
        if self.low >= self.high:
            raise SystemExit('min_temp must be below max_temp')
        if self.get_parameter('units').value not in ('C', 'F', 'K'):
            raise SystemExit('unknown units')
        depth = max(1, self.get_parameter('history_depth').value)
        self.pub = self.create_publisher(Float64, '/sensor/temperature', depth)
        self.info = self.create_publisher(String, '/sensor/info', depth)
        self.create_service(Trigger, '~/calibrate', self.calibrate)
        self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.tick)

    def calibrate(self, request, response):
        response.success = True
        return response

    def tick(self):
        value = random.uniform(self.low, self.high)
        self.pub.publish(Float64(data=value))
        self.info.publish(String(data='ok'))
        self.get_logger().info(f"{self.get_parameter('sensor_name').value}: {value:.2f}")


def main():
    rclpy.init()
    executor = SingleThreadedExecutor()
    executor.add_node(TemperaturePublisher())
    executor.add_node(Node('idle_friend'))
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
