#!/usr/bin/env python3
"""Chatter publisher. Every callback is a coroutine, so that the executor never has to wait for one."""

from typing import List

import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import String


class AsyncChatter(Node):

    def __init__(self) -> None:
        super().__init__('parameterized_publisher')
        self.message_prefix: str = self.declare_parameter('message_prefix', 'Hello').value
        self.publish_rate: float = self.declare_parameter('publish_rate', 1.0).value
        self.enabled: bool = self.declare_parameter('enabled', True).value

        self.sequence = 0
        self.chatter = self.create_publisher(String, 'chatter', 10)
        self.ticker = self.create_timer(1.0 / self.publish_rate, self.on_tick)
        self.add_on_set_parameters_callback(self.on_parameters)

    async def on_tick(self) -> None:
        if not self.enabled:
            return
        await self.send(f'{self.message_prefix} {self.sequence}')
        self.sequence += 1

    async def send(self, text: str) -> None:
        self.chatter.publish(String(data=text))

    async def on_parameters(self, parameters: List[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            if parameter.name == 'publish_rate' and parameter.value <= 0.0:
                return SetParametersResult(
                    successful=False,
                    reason=f'publish_rate must be positive, not {parameter.value}')
        for parameter in parameters:
            await self.apply(parameter)
        return SetParametersResult(successful=True)

    async def apply(self, parameter: Parameter) -> None:
        if parameter.name == 'message_prefix':
            self.message_prefix = parameter.value
        elif parameter.name == 'enabled':
            self.enabled = parameter.value
        elif parameter.name == 'publish_rate':
            self.publish_rate = parameter.value
            self.destroy_timer(self.ticker)
            self.ticker = self.create_timer(1.0 / self.publish_rate, self.on_tick)


def main(args=None) -> None:
    rclpy.init(args=args)
    node = AsyncChatter()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
