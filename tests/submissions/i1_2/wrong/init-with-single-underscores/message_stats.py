import rclpy
from rclpy.node import Node
from std_msgs.msg import String
import time

class StatsSubscriber(Node):
    def _init_(self):
        super()._init_('message_stats')

        self.total_count = 0
        self.first_message = None
        self.last_message = None
        self.start_time = None
        self.expected = None

        # Suscripción al tópico
        self.subscription = self.create_subscription(String, 'chatter', self.stats_callback, 10)

    def stats_callback(self, msg):
        if self.start_time is None:
            self.start_time = time.time()
            self.first_message = msg.data

        self.total_count += 1
        self.last_message = msg.data

        # Número de secuencia
        seq = int(msg.data.split()[-1])
        if self.expected is not None and seq > self.expected:
            self.get_logger().warning(f'Faltan {seq - self.expected} mensajes')
        elif self.expected is not None and seq < self.expected:
            self.get_logger().warning('El publicador se reinició')
        self.expected = seq + 1

        if self.total_count % 10 == 0:
            elapsed = time.time() - self.start_time
            rate = self.total_count / elapsed if elapsed > 0 else 0.0
            self.get_logger().info(f'Total: {self.total_count}, {rate:.2f} msg/s, '
                                   f'primero: {self.first_message}, último: {self.last_message}')

def main(args=None):
    rclpy.init(args=args)
    node = StatsSubscriber()
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()

if __name__ == '__main__':
    main()
