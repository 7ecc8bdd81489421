import threading

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import SingleThreadedExecutor


def main():
    rclpy.init()
    node = rclpy.create_node('client')
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    spinning = threading.Thread(target=executor.spin, daemon=True)
    spinning.start()
    for name in ('add', 'subtract', 'multiply', 'divide'):
        c = node.create_client(AddTwoInts, '/' + name)
        print(name, c.call(AddTwoInts.Request(a=9, b=3)).sum)
    executor.shutdown()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
