import random
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64

class TemperaturePublisher(Node):
    def __init__(self):
        super().__init__('temperature_publisher')
        # TODO: Create publisher for Float64 on /sensor/temperature
        # TODO: Create timer
        pass

    def timer_callback(self):
        # TODO: Generate random temperature between 20.0 and 30.0
        # TODO: Publish the value
        pass

def main():
    rclpy.init()
    node = TemperaturePublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()

if __name__ == '__main__':
    main()
