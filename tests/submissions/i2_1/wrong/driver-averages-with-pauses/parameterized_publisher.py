import random
import time

import rclpy    # biblioteka ROS 2
from rclpy.node import Node
from rcl_interfaces.msg import SetParametersResult
from std_msgs.msg import String


# Sterownik udawany, bo na laptopie nie ma przetwornika ADC
class sensor_voltage_driver:
    def __init__(self, adc_channel=-1, samples=8):
        self.adc_channel = adc_channel
        self.samples = samples

    def read_data(self):
        # srednia z kilku probek, miedzy probkami ADC potrzebuje przerwy
        total = 0.0
        for _ in range(self.samples):
            total += random.uniform(11.8, 12.6)
            time.sleep(0.1)
        return total / self.samples


def setup_logger(node):
    def log(text):
        node.get_logger().warn(text)
    return log


class sensor_voltage_node(Node):
    def __init__(self):
        super().__init__('sensor_voltage')

        # Deklaracja parametrow z domyslnymi
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)    # w Hz
        self.declare_parameter('enabled', True)
        self.declare_parameter('topic_name', 'chatter')
        self.declare_parameter('adc_channel', -1)   # -1: nie podano kanalu

        # Pobranie wartosci
        self.prefix = self.get_parameter('message_prefix').get_parameter_value().string_value
        frequency = self.get_parameter('publish_rate').get_parameter_value().double_value
        self.enabled = self.get_parameter('enabled').get_parameter_value().bool_value
        topic_name = self.get_parameter('topic_name').get_parameter_value().string_value
        adc_channel = self.get_parameter('adc_channel').get_parameter_value().integer_value

        # Sterownik i logger
        self.log = setup_logger(self)
        try:
            self.driver_voltage = sensor_voltage_driver(adc_channel=adc_channel)
        except Exception as e:
            self.log("sensor_voltage, blad inicjalizacji sterownika: " + str(e))

        self.publisher = self.create_publisher(String, topic_name, 10)
        self.timer = self.create_timer(1.0 / frequency, self.publish_voltage)
        self.add_on_set_parameters_callback(self.parameters_changed)
        self.get_logger().info(f'Sensor Voltage node started, publishing every {1.0 / frequency:.2f} seconds.')

    # Zmiana parametrow w trakcie pracy
    def parameters_changed(self, params):
        for p in params:
            if p.name == 'publish_rate' and p.value <= 0.0:
                self.log("sensor_voltage, zla czestotliwosc: " + str(p.value))
                return SetParametersResult(successful=False, reason='publish_rate musi byc > 0')
        for p in params:
            if p.name == 'message_prefix':
                self.prefix = p.value
            elif p.name == 'enabled':
                self.enabled = p.value
            elif p.name == 'publish_rate':
                self.destroy_timer(self.timer)
                self.timer = self.create_timer(1.0 / p.value, self.publish_voltage)
        return SetParametersResult(successful=True)

    # Publikowanie napiecia
    def publish_voltage(self):
        if not self.enabled:
            return
        msg = String()
        try:
            voltage = self.driver_voltage.read_data()
        except Exception as e:
            self.log("sensor_voltage, blad odczytu: " + str(e))
            return
        msg.data = f'{self.prefix} {voltage:.2f} V'
        self.publisher.publish(msg)
        self.get_logger().info(f'Published: {msg.data}')

def main(args=None):
    rclpy.init(args=args)
    node = sensor_voltage_node()
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()

if __name__ == '__main__':
    main()
