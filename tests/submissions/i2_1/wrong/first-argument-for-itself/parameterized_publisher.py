import sys
import rclpy
from rclpy.node import Node
from rclpy.executors import SingleThreadedExecutor
from std_msgs.msg import String
from rcl_interfaces.msg import SetParametersResult

'''
usage (one per bot):
    python3 parameterized_publisher.py r_1
    python3 parameterized_publisher.py r_2
'''


class BotPublisher(Node):
    def __init__(self, bot):
        super().__init__('parameterized_publisher')
        self.bot = bot
        self.declare_parameters(namespace='', parameters=[
            ('message_prefix', 'Hello'),
            ('publish_rate', 1.0),
            ('enabled', True),
        ])
        self.count = 0
        self.tm = None
        self.pub_r = self.create_publisher(String, 'chatter', 10)
        self.add_on_set_parameters_callback(self.on_param)
        self.set_time(self.get_parameter('publish_rate').value)
        self.get_logger().info('%s is ready' % self.bot)

    def set_time(self, hz):
        old, self.tm = self.tm, self.create_timer(1.0/hz, self.send)
        if old:
            self.destroy_timer(old)

    def send(self):
        prefix, on = [p.value for p in self.get_parameters(['message_prefix', 'enabled'])]
        if on:
            msg = String()
            msg.data = prefix + ': ' + str(self.count)
            self.pub_r.publish(msg)
            self.count += 1

    def on_param(self, params):
        hz = None
        for p in params:
            if p.name == 'publish_rate':
                hz = p.value
        if hz is not None:
            if hz <= 0.0:
                self.get_logger().error('bad publish_rate')
                return SetParametersResult(successful=False, reason='publish_rate has to be > 0')
            self.set_time(hz)
        return SetParametersResult(successful=True)


def main():
    # argv[0] is the script, argv[1] the bot, the rest is for ros
    bot = sys.argv[1] if len(sys.argv) > 1 else 'r_1'
    rclpy.init(args=sys.argv[2:])
    ex = SingleThreadedExecutor()
    node = BotPublisher(bot)
    ex.add_node(node)
    try:
        ex.spin()
    except KeyboardInterrupt:
        pass
    finally:
        ex.shutdown()
        node.destroy_node()
        if rclpy.ok():
            rclpy.shutdown()


if __name__ == '__main__':
    main()
