import random
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class TemperaturSensor(Node):
    """Veröffentlicht zufällige Temperaturen."""

    def __init__(self):
        super().__init__('temperatur_sensor')
        self.declare_parameter('sensorname', 'Küche')
        self.declare_parameter('messrate', 1.0)
        self.ausgabe = self.create_publisher(Float64, '/sensor/temperature', 10)
        messrate = self.get_parameter('messrate').value
        self.uhr = self.create_timer(1.0 / messrate, self.messen)

    def messen(self):
        wert = random.uniform(20.0, 30.0)
        self.ausgabe.publish(Float64(data=wert))
        ort = self.get_parameter('sensorname').value
        self.get_logger().warning(f'Sensor »{ort}« misst {wert:.1f} Grad')


def main():
    rclpy.init()
    knoten = TemperaturSensor()
    try:
        rclpy.spin(knoten)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        knoten.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
