import random
from functools import partial

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64

HABITACIONES = ('cocina', 'salon', 'laboratorio')


class SensorNode(Node):
    """Nodo que simula los sensores de la casa (uno por habitación)"""

    def __init__(self):
        super().__init__('sensor_node')
        self.declare_parameter('sensor_name', 'casa')
        self.declare_parameter('publish_rate', 1.0)  # Hz

        self.nombre = self.get_parameter('sensor_name').value
        frecuencia = self.get_parameter('publish_rate').value

        self.ultimas = dict.fromkeys(HABITACIONES)
        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)

        # un timer para cada habitación
        self.timers_ = {}
        for h in HABITACIONES:
            self.timers_[h] = self.create_timer(1.0 / frecuencia, partial(self.publicar, h))
        self.get_logger().info(f'Nodo {self.nombre} listo, {frecuencia} Hz')

    def publicar(self, habitacion):
        msg = Float64()
        msg.data = random.uniform(20.0, 30.0)
        self.ultimas[habitacion] = msg.data
        self.pub.publish(msg)
        self.get_logger().info(f'{self.nombre}/{habitacion} publicó: {msg.data:.1f}')


def main(args=None):
    rclpy.init(args=args)
    node = SensorNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
