
import abc
import time

import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class SimplePublishNode(Node):

    def __init__(self, topic: str, MSG_TYPE=String, timer_period: float = 1.0):
        super().__init__('SimplePublishNode')
        self._publisher = self.create_publisher(MSG_TYPE, topic, 10)
        self._timer = self.create_timer(timer_period, self.__timer_callback)

    def __timer_callback(self):
        msg = self.prepare_msg()
        self._publisher.publish(msg)

    @abc.abstractmethod
    def prepare_msg(self):

        msg = String()
        msg.data = 'hello world'
        return msg


class SimpleSubscribeNode(Node):

    def __init__(self, topic: str, MSG_TYPE=String, timer_period: float = 1.0):
        super().__init__('SimpleSubscribeNode')

        self.subscription = self.create_subscription(
            MSG_TYPE,
            topic,
            self.handle_msg,
            10)
        self.subscription  # prevent unused variable warning

    @abc.abstractmethod
    def handle_msg(self, msg):
        self.get_logger().info('I heard: "%s"' % msg.data)


class StatisticsNode(SimpleSubscribeNode):

    def __init__(self):
        super().__init__('chatter')
        self._amount = 0
        self._begin = None
        self._texts = [None, None]      # first, last
        self._previous = None

    def handle_msg(self, msg):
        if self._begin is None:
            self._begin = time.perf_counter()
            self._texts[0] = msg.data
        self._texts[1] = msg.data
        self._amount += 1

        number = int(msg.data.split()[2])
        self.check_number(number)
        self._previous = number

        if self._amount % 10 == 0:
            self.show_statistics()

    def check_number(self, number):
        if self._previous is None:
            return
        if number > self._previous:
            pass        # going up, nothing to say
        elif number > self._previous + 1:
            self.get_logger().warning('lost %d messages' % (number - self._previous - 1))
        else:
            self.get_logger().warning('publisher was restarted')

    def show_statistics(self):
        seconds = time.perf_counter() - self._begin
        speed = self._amount / seconds if seconds else 0.0
        self.get_logger().info('Received: %d, %.2f msg/s, first: "%s", last: "%s"'
                               % (self._amount, speed, self._texts[0], self._texts[1]))


def main(args=None):
    rclpy.init(args=args)
    node = StatisticsNode()
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
