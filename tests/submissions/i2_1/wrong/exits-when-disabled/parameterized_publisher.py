#!/usr/bin/env python3
from typing import Any, Optional

import rclpy
import rclpy.node
import rclpy.timer
import rcl_interfaces.msg
import std_msgs.msg


def text(prefix: str, number: int) -> std_msgs.msg.String:
    return std_msgs.msg.String(data=f"{prefix} {number}")


class TalkerOnce(rclpy.node.Node):  # type: ignore
    def __init__(self) -> None:
        super().__init__("parameterized_publisher")
        self.prefix = self.declare_parameter('message_prefix', 'Hello').value
        self.rate = self.declare_parameter('publish_rate', 1.0).value
        self.enabled = self.declare_parameter('enabled', True).value
        self.pub = self.create_publisher(std_msgs.msg.String, 'chatter', 1)
        self.number = 0
        self.timer: Optional[rclpy.timer.Timer]
        if self.rate:
            self.get_logger().info(f"Start timer with rate {self.rate}")
            self.timer = self.create_timer(1.0 / self.rate, self.publish)
        else:
            self.timer = None
        self.add_on_set_parameters_callback(self.parameter_callback)
        self.get_logger().info("Ready")

    def parameter_callback(self, params: Any) -> rcl_interfaces.msg.SetParametersResult:
        for param in params:
            if param.name == 'publish_rate':
                if not param.value:
                    return rcl_interfaces.msg.SetParametersResult(
                        successful=False, reason="publish_rate: a rate is required")
                self.rate = param.value
                period_ns = round(1e9 / self.rate)
                if not self.timer:
                    self.timer = self.create_timer(1.0 / self.rate, self.publish)
                elif period_ns != self.timer.timer_period_ns:
                    self.timer.timer_period_ns = period_ns
                    self.timer.reset()
            if param.name == 'message_prefix':
                self.prefix = param.value
            if param.name == 'enabled':
                self.enabled = param.value
        return rcl_interfaces.msg.SetParametersResult(successful=True)

    def publish(self) -> None:
        if not self.enabled:
            self.get_logger().info('Publishing complete.')
            self.destroy_timer(self.timer)
            # Exit node since it's done
            raise SystemExit
        self.pub.publish(text(self.prefix, self.number))
        self.number += 1


def main(args: Any = None) -> None:
    rclpy.init(args=args)
    node = TalkerOnce()
    try:
        rclpy.spin(node)
    except SystemExit:
        pass
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
