#!/usr/bin/env python3

import random
import time

import rclpy
from rclpy.node import Node

from std_msgs.msg import Float64


def sensor_value(low, high, interval=None):
    # same idea as psutil.cpu_percent(interval=...): first value, wait, second value
    first = random.uniform(low, high)
    if interval:
        time.sleep(interval)
    return (first + random.uniform(low, high)) / 2


class RoomClimatePublisherNode(Node):

    def __init__(self):
        super().__init__('room_climate_publisher_node')
        self.get_logger().info('room_climate_publisher_node started')

        self._publish_rate = self.declare_parameter(
            'publish_rate',
            1.0).value  # [Hz]
        self._temp_interval = self.declare_parameter(
            'temp_interval',
            0.5).value  # [sec]
        self._sensor_name = self.declare_parameter(
            'sensor_name',
            'room').value

        if self._temp_interval > 1/self._publish_rate:
            self.get_logger().warn(
                'temp_interval does not fit into one period, '
                'using 1/publish_rate for it.')
            self._temp_interval = 1/self._publish_rate

        self.temperature_pub = self.create_publisher(
            Float64,
            '/sensor/temperature',
            1)
        self.humidity_pub = self.create_publisher(
            Float64,
            '/sensor/humidity',
            1)

        self.timer = self.create_timer(
            1/self._publish_rate,
            self.timer_callback)

    def timer_callback(self):
        temperature = sensor_value(20.0, 30.0, interval=self._temp_interval)
        self.get_logger().info(f'{self._sensor_name} temperature: {temperature:.2f} C')
        self.temperature_pub.publish(Float64(data=temperature))

        humidity = sensor_value(35.0, 60.0)
        self.get_logger().debug(f'{self._sensor_name} humidity: {humidity:.2f} %')
        self.humidity_pub.publish(Float64(data=humidity))


def main(args=None):
    rclpy.init(args=args)

    room_climate_publisher_node = RoomClimatePublisherNode()

    rclpy.spin(room_climate_publisher_node)

    room_climate_publisher_node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
