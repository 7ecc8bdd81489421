import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import HistoryPolicy, QoSProfile
from std_msgs.msg import Int32, String

TOPICS = {'/map': String, '/range': Int32, '/parcels': String}


class Monitor(Node):
    def __init__(self):
        super().__init__('warehouse_monitor')
        self.waiting = dict(TOPICS)
        self.subs = []
        self.look = self.create_timer(0.1, self.look_around)

    def look_around(self):
        for topic in list(self.waiting):
            infos = self.get_publishers_info_by_topic(topic)
            if not infos:
                continue
            offered = infos[0].qos_profile
            profile = QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=1000,
                                 reliability=offered.reliability, durability=offered.durability)
            kind = self.waiting.pop(topic)
            self.subs.append(self.create_subscription(kind, topic, self.logging(topic), profile))
        if not self.waiting:
            self.look.cancel()

    def logging(self, topic):
        def log(message):
            self.get_logger().info(f'{topic}: {message.data}')
        return log


def main():
    rclpy.init()
    try:
        rclpy.spin(Monitor())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
