#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from std_msgs.msg import String
from rcl_interfaces.msg import SetParametersResult

class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')

        # Declare parameters
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)

        # Get initial values
        self.prefix = self.get_parameter('message_prefix').value
        self.rate = self.get_parameter('publish_rate').value
        self.enabled = self.get_parameter('enabled').value

        # Register callback
        self.add_on_set_parameters_callback(self.param_callback)

        # Create publisher and timer
        self.publisher = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1.0 / self.rate, self.timer_callback)
        self.count = 0

        self.get_logger().info(f'Started with prefix="{self.prefix}", rate={self.rate}')

    def param_callback(self, params):
        for p in params:
            if p.name == 'publish_rate':
                if p.value <= 0:
                    return SetParametersResult(
                        successful=False,
                        reason='Rate must be positive'
                    )
                self.rate = p.value
                self.destroy_timer(self.timer)
                self.timer = self.create_timer(1.0 / self.rate, self.timer_callback)
            elif p.name == 'message_prefix':
                self.prefix = p.value
            elif p.name == 'enabled':
                self.enabled = p.value

        return SetParametersResult(successful=True)

    def timer_callback(self):
        if not self.enabled:
            return

        msg = String()
        msg.data = f'{self.prefix} #{self.count}'
        self.publisher.publish(msg)
        self.get_logger().info(f'Published: {msg.data}')
        self.count += 1

def main():
    rclpy.init()
    node = ParameterizedPublisher()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    node.destroy_node()
    rclpy.shutdown()

if __name__ == '__main__':
    main()
