#!/usr/bin/env python3
# doc cam bien nhiet do (gia lap), bai tap tuan 3
import random

import rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter
from rcl_interfaces.msg import SetParametersResult
from std_msgs.msg import Float64

NGUONG_CANH_BAO = 35.0   # do C


class CTDNode(Node):
    def __init__(self):
        super().__init__('ctd_temperature')

        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('sensor_name', 'ctd0')
        self.sensor_name = self.get_parameter('sensor_name').get_parameter_value().string_value
        self.add_on_set_parameters_callback(self.parameters_callback)

        self.publisher_temp = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.timer = None
        self.setup_timer(self.get_parameter('publish_rate').value)

    def parameters_callback(self, params):
        for param in params:
            if param.name == 'publish_rate':
                if param.type_ != Parameter.Type.DOUBLE or param.value <= 0.0:
                    return SetParametersResult(successful=False, reason='publish_rate phai > 0')
                self.setup_timer(param.value)
            elif param.name == 'sensor_name':
                self.sensor_name = param.value
        return SetParametersResult(successful=True)

    def setup_timer(self, rate):
        if self.timer is not None:
            self.destroy_timer(self.timer)
        self.timer = self.create_timer(1.0 / rate, self.publish_dummy_data)
        self.get_logger().info(f"Running in simulation mode, {rate} Hz")

    def publish_dummy_data(self):
        temp_msg = Float64(data=random.uniform(20.0, 30.0))
        self.publisher_temp.publish(temp_msg)
        if temp_msg.data > NGUONG_CANH_BAO:
            self.get_logger().warn(f"{self.sensor_name}: qua nhiet! T={temp_msg.data:.2f}")
        else:
            self.get_logger().debug(f"T={temp_msg.data:.2f}")


def main(args=None):
    rclpy.init(args=args)
    node = None
    try:
        node = CTDNode()
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    except Exception as e:
        print(f"Unhandled exception: {e}")
    finally:
        if node:
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
