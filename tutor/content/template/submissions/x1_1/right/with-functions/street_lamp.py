import rclpy
from rclpy.node import Node
from std_msgs.msg import String


def main():
    rclpy.init()
    node = Node("lamp")
    publisher = node.create_publisher(String, "street_lamp/status", 1)

    def tell():
        publisher.publish(String(data="I am ready"))

    node.create_timer(1 / 2, tell)
    rclpy.spin(node)


main()
