import time
import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException


def check(params):
    for p in params:
        if p.name == 'publish_rate' and p.value <= 0.0:
            return SetParametersResult(successful=False, reason='The rate must be > 0')
    return SetParametersResult(successful=True)


def main():
    from std_msgs.msg import String
    rclpy.init()
    node = rclpy.create_node('loop')
    node.declare_parameter('message_prefix', 'Hello')
    node.declare_parameter('publish_rate', 1.0)
    node.declare_parameter('enabled', True)
    node.add_on_set_parameters_callback(check)
    pub = node.create_publisher(String, '/chatter', 10)
    count = 0
    last = 0.0
    while rclpy.ok():
        period = 1.0 / node.get_parameter('publish_rate').value
        left = last + period - time.monotonic()
        if left > 0:
            rclpy.spin_once(node, timeout_sec=left)
            continue
        last = time.monotonic()
        if node.get_parameter('enabled').value:
            count += 1
            pub.publish(String(data=node.get_parameter('message_prefix').value + ' ' + str(count)))


if __name__ == '__main__':
    try:
        main()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
