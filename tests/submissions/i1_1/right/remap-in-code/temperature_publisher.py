import random
import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64

# The driver talks on "~/out"; where that goes is decided by the remap rules below.
REMAPS = ['--ros-args', '-r', '~/out:=/sensor/temperature']


def make_driver():
    node = rclpy.create_node('temperature_publisher', cli_args=REMAPS)
    rate = node.declare_parameter('publish_rate', 3.0).value
    name = node.declare_parameter('sensor_name', 'generic_driver').value
    out = node.create_publisher(Float64, '~/out', 10)

    def publish():
        out.publish(Float64(data=random.uniform(20, 30)))

    node.create_timer(1.0 / rate, publish)
    node.get_logger().info(f'{name} publishes on {out.topic_name}')
    return node


def main():
    rclpy.init()
    node = make_driver()
    try:
        while rclpy.ok():
            rclpy.spin_once(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
