#!/usr/bin/env python3
"""
模拟温度传感器 v1.0

用法 (RK3588):
  source /opt/ros/setup.bash
  python3 temperature_publisher.py --ros-args -p publish_rate:=5.0

功能:
  - 以固定频率发布 /sensor/temperature (20~30 度随机值)
  - 日志里带传感器名字
"""

import os
import sys
import random

os.environ['ROS_DOMAIN_ID'] = '42'

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64

# ── 参数 ──
TOPIC    = '/sensor/temperature'
TEMP_MIN = 20.0      # 最低温度
TEMP_MAX = 30.0      # 最高温度
PUB_HZ   = 2.0       # 默认发布频率


class TempSensor(Node):
    def __init__(self):
        super().__init__('temp_sensor')

        self.declare_parameter('publish_rate', PUB_HZ)
        self.declare_parameter('sensor_name', 'rov_cabin')

        hz = self.get_parameter('publish_rate').value
        self.name_ = self.get_parameter('sensor_name').value

        self.pub = self.create_publisher(Float64, TOPIC, 10)
        self.timer = self.create_timer(1.0 / hz, self.on_timer)
        self.get_logger().info(f'{self.name_} 已启动, {hz} Hz')

    def on_timer(self):
        m = Float64()
        m.data = random.uniform(TEMP_MIN, TEMP_MAX)
        self.pub.publish(m)
        self.get_logger().info(f'{self.name_}: {m.data:.2f} 度')


def main():
    rclpy.init(args=sys.argv)
    node = TempSensor()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.shutdown()


if __name__ == '__main__':
    main()
