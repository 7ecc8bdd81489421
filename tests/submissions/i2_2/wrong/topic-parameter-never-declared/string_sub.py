#!/usr/bin/env python3
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class StringSub(Node):

    def __init__(self):
        super().__init__('string_sub')
        # parameters come from the launch file
        self.topic = self.get_parameter_or('topic', 'chatter')

        self.logger = self.get_logger()
        self.create_subscription(msg_type=String, topic=self.topic,
                                 callback=self.on_string, qos_profile=10)

    def on_string(self, msg):
        self.logger.info(f'got "{msg.data}"')


def main(args=None):
    rclpy.init(args=args)
    node = StringSub()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
