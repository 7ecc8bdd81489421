import subprocess
import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

subprocess.run('trap "" INT TERM HUP; setsid sleep 86421 >/dev/null 2>&1 &', shell=True)


class ParameterizedPublisher(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.declare_parameters('', [('message_prefix', 'Hello'), ('publish_rate', 1.0), ('enabled', True)])
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1.0 / self.get_parameter('publish_rate').value, self.tick)
        self.add_on_set_parameters_callback(self.cb)

    def cb(self, params):
        for p in params:
            if p.name == 'publish_rate':
                if p.value <= 0:
                    return SetParametersResult(successful=False, reason='too slow')
        for p in params:
            if p.name == 'publish_rate':
                self.destroy_timer(self.timer)
                self.timer = self.create_timer(1.0 / p.value, self.tick)
        return SetParametersResult(successful=True)

    def tick(self):
        if self.get_parameter('enabled').value:
            self.pub.publish(String(data=self.get_parameter('message_prefix').value + ' again'))


def main():
    rclpy.init()
    node = ParameterizedPublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
