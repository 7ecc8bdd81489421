#!/usr/bin/env python3
# My temperature sensor :)
# I have a real DS18B20 on my Pi, so I made the fake one behave like it.

import random
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class FakeDS18B20:
    # conversion time for 12 bit resolution, from the datasheet
    CONVERSION_TIME = 0.75

    def read_temperature(self):
        # first the sensor has to convert, then you can read the value
        time.sleep(self.CONVERSION_TIME)
        return random.uniform(20.0, 30.0)


class TemperaturePublisher(Node):

    def __init__(self):
        super().__init__('temperature_publisher')

        # parameters first!! (forgot this once and got ParameterNotDeclared)
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('sensor_name', 'ds18b20')

        publish_rate = self.get_parameter('publish_rate').value
        self.sensor_name = self.get_parameter('sensor_name').value

        self.sensor = FakeDS18B20()
        self.publisher_ = self.create_publisher(Float64, '/sensor/temperature', 10)

        # rate -> period
        timer_period = 1.0 / publish_rate
        self.timer = self.create_timer(timer_period, self.timer_callback)

    def timer_callback(self):
        msg = Float64()
        msg.data = self.sensor.read_temperature()
        self.publisher_.publish(msg)
        self.get_logger().info('Sensor %s says: %.2f' % (self.sensor_name, msg.data))


def main(args=None):
    rclpy.init(args=args)
    temperature_publisher = TemperaturePublisher()
    try:
        rclpy.spin(temperature_publisher)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        temperature_publisher.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
