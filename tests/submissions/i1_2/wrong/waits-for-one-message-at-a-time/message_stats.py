import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.wait_for_message import wait_for_message
from std_msgs.msg import String


def main():
    rclpy.init()
    node = rclpy.create_node('message_stats')
    count, first, last_number, start = 0, '', None, 0.0
    try:
        while rclpy.ok():
            ok, msg = wait_for_message(String, node, 'chatter')
            if not ok:
                continue
            now = time.monotonic()
            if count == 0:
                first, start = msg.data, now
            count += 1
            number = int(msg.data.split(':')[1])
            if last_number is not None and number > last_number + 1:
                node.get_logger().warning(f'{number - last_number - 1} missing between {last_number} and {number}')
            last_number = number
            if count % 10 == 0:
                rate = (count - 1) / (now - start)
                node.get_logger().info(f'{count} messages, {rate:.2f} per second, first "{first}", last "{msg.data}"')
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
