#!/usr/bin/env python3

import random
import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64


class Termometro(Node):
    """Nodo della stazione meteo, gira finche' non si preme Ctrl+C"""

    def __init__(self):
        super().__init__('temperature_publisher')
        # parametri
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('sensor_name', 'termometro_cucina')
        self.frequenza = self.get_parameter('publish_rate').value
        self.nome = self.get_parameter('sensor_name').value

        self.temp_pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.get_logger().info('Avvio di %s' % self.nome)
        self.avvia()
        self.timer = self.create_timer(1.0 / self.frequenza, self.misura)

    def avvia(self):
        rclpy.spin(self)

    def misura(self):
        temperatura = Float64()
        temperatura.data = random.uniform(20.0, 30.0)
        self.temp_pub.publish(temperatura)
        self.get_logger().info('%s: %.2f gradi' % (self.nome, temperatura.data))


def main(args=None):
    rclpy.init(args=args)
    try:
        Termometro()
    except KeyboardInterrupt:
        pass
    rclpy.shutdown()


if __name__ == '__main__':
    main()
