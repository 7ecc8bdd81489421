import rclpy
from rclpy.node import Node
import random
from std_msgs.msg import Float64


class MinimalPublisher(Node):

    def __init__(self):
        super().__init__('temperature_publisher')
        self.publisher_ = self.create_publisher(Float64, '/sensor/temperature', 10)
        timer_period = 0.5  # seconds
        self.timer = self.create_timer(timer_period, self.timer_callback)
        self.i = 0

        # sensor name in the log messages
        self.declare_parameter('sensor_name', 'sensor_2')
        self.sensor_name = self.get_parameter('sensor_name').value

        # make the publishing rate configurable
        self.declare_parameter('publish_rate', 2.0)
        self.set_rate(self.get_parameter('publish_rate').value)

    def set_rate(self, rate):
        if rate <= 0.0:
            self.get_logger().error('%s: bad rate %s' % (self.sensor_name, rate))
            return
        self.timer = self.create_timer(1.0 / rate, self.timer_callback)

    def timer_callback(self):
        msg = Float64()
        msg.data = random.uniform(20.0, 30.0)
        self.publisher_.publish(msg)
        self.get_logger().info('%s publishing: "%s"' % (self.sensor_name, msg.data))
        self.i += 1


def main(args=None):
    rclpy.init(args=args)

    minimal_publisher = MinimalPublisher()

    rclpy.spin(minimal_publisher)

    # Destroy the node explicitly
    # (optional - otherwise it will be done automatically
    # when the garbage collector destroys the node object)
    minimal_publisher.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
