# -*- coding: utf-8 -*-
# 温度传感器仿真节点：采样和发布分开（和单片机上的做法一样，定时器中断里采样，主循环里上报）
import random

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64

REPORT_PERIOD = 0.5  # 上报周期（秒）


class TemperatureNode(Node):

    def __init__(self):
        super().__init__('temperature_node')

        # 声明参数
        self.declare_parameter('sample_rate', 10.0)      # 采样频率 Hz
        self.declare_parameter('sensor_name', 'DHT22')   # 传感器名称

        self.sensor_name = self.get_parameter('sensor_name').value
        sample_rate = self.get_parameter('sample_rate').value

        self.latest = None
        self.sample()

        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.sample_timer = self.create_timer(1.0 / sample_rate, self.sample)
        self.report_timer = self.create_timer(REPORT_PERIOD, self.report)

        self.get_logger().info(f'{self.sensor_name} 启动，采样频率 {sample_rate} Hz')

    def sample(self):
        """采样：20~30 度之间的随机数"""
        self.latest = random.uniform(20.0, 30.0)

    def report(self):
        """上报：把最近一次的采样值发出去"""
        msg = Float64()
        msg.data = self.latest
        self.pub.publish(msg)
        self.get_logger().info(f'{self.sensor_name} 当前温度: {msg.data:.2f}')


def main(args=None):
    rclpy.init(args=args)
    node = TemperatureNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        if rclpy.ok():
            rclpy.shutdown()


if __name__ == '__main__':
    main()
