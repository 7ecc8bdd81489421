import sys

import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        self.declare_parameters('', [
            ('message_prefix', 'Hello'),
            ('publish_rate', 1.0),
            ('enabled', True),
        ])
        if self.get_parameter('publish_rate').value <= 0:
            raise ValueError('publish_rate must be greater than zero')
        self.i = 0
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(1 / self.get_parameter('publish_rate').value, self.tick)
        self.add_on_set_parameters_callback(self.on_set)

    def on_set(self, params):
        rate = None
        for p in params:
            if p.name is 'publish_rate':
                if p.value <= 0:
                    return SetParametersResult(successful=False, reason=f'{p.value} Hz? A rate is more than zero.')
                rate = p.value
        if rate is not None:
            self.timer.cancel()
            self.timer = self.create_timer(1 / rate, self.tick)
        return SetParametersResult(successful=True)

    def tick(self):
        if self.get_parameter('enabled').value:
            self.i += 1
            self.pub.publish(String(data=self.get_parameter('message_prefix').value + f' {self.i}'))


def main():
    rclpy.init()
    try:
        rclpy.spin(Talker())
    except ValueError as e:
        sys.exit(f'error: {e}')
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
