import time
import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from std_msgs.msg import Int32, String

time.sleep(2.0)


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('talker', namespace='/office')
        self.declare_parameter('burst', 1)
        self.declare_parameter('enabled', True)
        self.declare_parameter('gain', 0.5)
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('suffix', '!')
        for i in range(200):
            self.get_logger().warn(f'loading module {i}')
        time.sleep(1.0)
        self.pub = self.create_publisher(String, '/chatter', qos_profile_sensor_data)
        self.stat = self.create_publisher(Int32, 'sent', 10)
        self.sent = 0
        self.restart()
        self.add_on_set_parameters_callback(self.check)
        self.add_post_set_parameters_callback(lambda params: self.restart(params))

    def check(self, params):
        for p in params:
            if p.name == 'publish_rate' and p.value <= 0:
                return SetParametersResult(successful=False, reason=f'publish_rate {p.value} is not positive')
            if p.name == 'burst' and p.value < 1:
                return SetParametersResult(successful=False, reason='burst must be 1 or more')
        return SetParametersResult(successful=True)

    def restart(self, params=None):
        if params is not None:
            if not any(p.name == 'publish_rate' for p in params):
                return
            self.destroy_timer(self.timer)
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.tick)

    def tick(self):
        print('tick')
        self.get_logger().info('tick')
        if not self.get_parameter('enabled').value:
            self.get_logger().warn('disabled, sending nothing')
            return
        text = self.get_parameter('message_prefix').value + ' ' + str(self.sent) + self.get_parameter('suffix').value
        self.pub.publish(String(data=text))
        self.stat.publish(Int32(data=self.sent))
        self.sent += 1


def main():
    rclpy.init()
    node = None
    try:
        node = ParameterizedPublisher()
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
