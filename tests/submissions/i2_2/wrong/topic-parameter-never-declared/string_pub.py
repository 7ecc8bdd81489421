#!/usr/bin/env python3
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class StringPub(Node):

    def __init__(self):
        super().__init__('string_pub')
        # parameters come from the launch file
        self.topic = self.get_parameter_or('topic', 'chatter')
        self.rate = self.get_parameter_or('rate', 2.0)

        self.logger = self.get_logger()
        self.counter = 0
        self.pub = self.create_publisher(msg_type=String, topic=self.topic, qos_profile=10)
        self.create_timer(1.0 / self.rate, self.tick)
        self.logger.info(f'publishing on {self.pub.topic_name}')

    def tick(self):
        self.pub.publish(String(data=f'string {self.counter}'))
        self.counter += 1


def main(args=None):
    rclpy.init(args=args)
    node = StringPub()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
