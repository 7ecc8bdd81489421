#!/usr/bin/env python3
# -*- coding: utf-8 -*-

"""
@说明: ROS2话题示例-发布模拟温度数据
"""

import random
import rclpy                                     # ROS2 Python接口库
from rclpy.node   import Node                    # ROS2 节点类
from std_msgs.msg import Float64                 # 64位浮点消息类型

class TemperatureNode(Node):
    def __init__(self, name):
        super().__init__(name)                                    # ROS2节点父类初始化
        self.declare_parameter('sensor_name', 'mbot_temp')        # 传感器名字, 出现在日志里
        self.declare_parameter('publish_rate', 2.0)               # 发布频率(Hz)
        self.sensor_name = self.get_parameter('sensor_name').get_parameter_value().string_value
        rate = self.get_parameter('publish_rate').get_parameter_value().double_value

        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)   # 创建发布者
        self.timer = self.create_timer(1.0 / rate, self.timer_callback)        # 创建一个定时器
        self.get_logger().info('温度传感器启动, 频率 %.1f Hz' % rate)

    def timer_callback(self):                                     # 定时器周期执行的回调函数
        msg = Float64()                                           # 创建消息对象
        msg.data = random.uniform(20.0, 30.0)                     # 20到30之间的随机温度
        self.pub.publish(msg)                                     # 发布话题消息
        self.get_logger().info('[{self.sensor_name}] 温度: %.2f' % msg.data)   # 输出日志信息

def main(args=None):                                 # ROS2节点主入口main函数
    rclpy.init(args=args)                            # ROS2 Python接口初始化
    node = TemperatureNode("temperature_publisher")  # 创建ROS2节点对象并进行初始化
    rclpy.spin(node)                                 # 循环等待ROS2退出
    node.destroy_node()                              # 销毁节点对象
    rclpy.shutdown()                                 # 关闭ROS2 Python接口

if __name__ == '__main__':
    main()
