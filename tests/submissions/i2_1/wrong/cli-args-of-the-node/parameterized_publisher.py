#!/usr/bin/env python3

import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy, HistoryPolicy
from rcl_interfaces.msg import SetParametersResult
from std_msgs.msg import String

NODE_NAME = 'mockup_chatter'


class MockupChatter(Node):
    """Publishes fake chatter for testing."""

    def __init__(self) -> None:
        # same as: ros2 run my_package parameterized_publisher --ros-args -p publish_rate:=1.0
        super().__init__(NODE_NAME, cli_args=['--ros-args', '-p', 'publish_rate:=1.0'])

        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)

        rate = self.get_parameter('publish_rate').get_parameter_value().double_value
        self._prefix = self.get_parameter('message_prefix').get_parameter_value().string_value
        self._enabled = self.get_parameter('enabled').get_parameter_value().bool_value

        qos = QoSProfile(
            reliability=ReliabilityPolicy.RELIABLE,
            history=HistoryPolicy.KEEP_LAST,
            depth=10
        )
        self._pub = self.create_publisher(String, 'chatter', qos)
        self._timer = self.create_timer(1.0 / rate, self._publish_status)
        self._count = 0

        self.add_on_set_parameters_callback(self._on_set)

        self.get_logger().info(f'MockupChatter ready | rate={rate}Hz')

    def _on_set(self, params):
        for param in params:
            if param.name == 'publish_rate':
                if param.value <= 0.0:
                    return SetParametersResult(successful=False, msg='rate must be > 0')
                self.destroy_timer(self._timer)
                self._timer = self.create_timer(1.0 / param.value, self._publish_status)
            elif param.name == 'message_prefix':
                self._prefix = param.value
            elif param.name == 'enabled':
                self._enabled = param.value
        return SetParametersResult(successful=True)

    def _publish_status(self) -> None:
        """Publish fake chatter."""
        if not self._enabled:
            return
        msg = String()
        msg.data = f'{self._prefix} {self._count}'
        self._pub.publish(msg)
        self._count += 1


def main(args=None) -> None:
    rclpy.init(args=args)
    node = MockupChatter()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
