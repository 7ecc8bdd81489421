#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from std_msgs.msg import String
from rcl_interfaces.msg import SetParametersResult


class ParamPublisher(Node):

    def __init__(self):
        super().__init__("param_publisher")
        self.declare_parameters('', [('message_prefix', 'Hello'), ('publish_rate', 1.0), ('enabled', True)])
        self.pub = self.create_publisher(String, "chatter", 10)
        self.i = 0
        self.start_timer()
        self.add_on_set_parameters_callback(self.on_params)

    def start_timer(self):
        hz = self.get_parameter("publish_rate").get_parameter_value().double_value
        self.timer = self.create_timer(1.0 / hz, self.tick)

    def on_params(self, params):
        for p in params:
            if p.name == "publish_rate" and p.value <= 0:
                return SetParametersResult(successful=False, reason="rate must be > 0")
            if p.name == "publish_rate":
                self.timer.cancel()
                self.timer = self.create_timer(1.0 / p.value, self.tick)
        return SetParametersResult(successful=True)

    def tick(self):
        if not self.get_parameter("enabled").value:
            return
        self.set_parameters([rclpy.Parameter('publish_rate', value=1.0)])
        msg = String()
        msg.data = "%s %d" % (self.get_parameter("message_prefix").value, self.i)
        self.pub.publish(msg)
        self.i += 1


def main():
    rclpy.init()
    node = ParamPublisher()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
