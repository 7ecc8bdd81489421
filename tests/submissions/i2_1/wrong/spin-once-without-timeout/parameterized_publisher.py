import time

import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from std_msgs.msg import String


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.add_on_set_parameters_callback(self.on_params)
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.i = 0

    def on_params(self, params):
        for p in params:
            if p.name == 'publish_rate' and not 0.01 <= p.value <= 1000.0:
                return SetParametersResult(successful=False, reason='publish_rate out of range')
        return SetParametersResult(successful=True)

    def publish_once(self):
        if self.get_parameter('enabled').value:
            msg = String()
            msg.data = f"{self.get_parameter('message_prefix').value} #{self.i}"
            self.pub.publish(msg)
            self.i += 1


def main():
    rclpy.init()
    node = ParameterizedPublisher()
    try:
        while rclpy.ok():
            node.publish_once()
            rclpy.spin_once(node)
            time.sleep(1.0 / node.get_parameter('publish_rate').value)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
