#!/usr/bin/env python3
# spin() in a background thread, everything else in the main thread
import queue
import threading
import time

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import String

inbox = queue.SimpleQueue()


class Listener(Node):
    def __init__(self):
        super().__init__('message_stats')
        self.create_subscription(String, 'chatter', self.put, 10)

    def put(self, msg):
        inbox.put((time.monotonic(), msg.data))


def spin(executor):
    try:
        executor.spin()
    except ExternalShutdownException:
        pass


def statistics(log):
    count, missing, previous = 0, 0, None
    first, start = None, None
    while rclpy.ok():
        try:
            stamp, text = inbox.get(timeout=0.2)
        except queue.Empty:
            continue
        count += 1
        if first is None:
            first, start = text, stamp
        number = int(text.split(':')[1].strip())
        if previous is not None and number > previous:
            missing += number - previous - 1
        previous = number
        if count % 10 == 0:
            log.info('=== %d messages ===' % count)
            log.info('rate    : %.2f msg/s' % (count / (stamp - start)))
            log.info('first   : %s' % first)
            log.info('last    : %s' % text)
            if missing:
                log.warning('missing : %d' % missing)
            log.info('====================')


def main():
    rclpy.init()
    node = Listener()
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    thread = threading.Thread(target=spin, args=(executor,), daemon=True)
    thread.start()
    try:
        statistics(node.get_logger())
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()
    thread.join(timeout=2.0)
    node.destroy_node()


if __name__ == '__main__':
    main()
