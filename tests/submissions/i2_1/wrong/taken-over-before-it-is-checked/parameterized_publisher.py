#!/usr/bin/env python3
"""chatter with knobs: message_prefix, publish_rate, enabled."""

import sys
from dataclasses import asdict, dataclass

import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

OK = SetParametersResult(successful=True)


@dataclass
class Config:
    message_prefix: str = 'Hello'
    publish_rate: float = 1.0
    enabled: bool = True

    @property
    def period(self):
        # the timer wants seconds; never divide by zero
        return 1.0 / max(self.publish_rate, 0.1)


class Chatter(Node):
    def __init__(self):
        super().__init__('parameterized_publisher')
        self.cfg = Config()
        for name, default in asdict(self.cfg).items():
            setattr(self.cfg, name, self.declare_parameter(name, default).value)
        if self.cfg.publish_rate <= 0.0:
            raise ValueError(f'publish_rate must be positive, not {self.cfg.publish_rate}')

        self.n = 0
        self.new_period = False
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(self.cfg.period, self.tick)

        # first look at the values, then take them over
        self.add_on_set_parameters_callback(self.validate)
        self.add_on_set_parameters_callback(self.take_over)

    def validate(self, params):
        for p in params:
            if p.name == 'publish_rate' and p.value <= 0.0:
                return SetParametersResult(
                    successful=False,
                    reason=f'{p.name} must be positive, not {p.value}')
        return OK

    def take_over(self, params):
        for p in params:
            if hasattr(self.cfg, p.name):
                setattr(self.cfg, p.name, p.value)
            if p.name == 'publish_rate':
                self.new_period = True
        return OK

    def tick(self):
        if self.new_period:
            self.new_period = False
            self.destroy_timer(self.timer)
            self.timer = self.create_timer(self.cfg.period, self.tick)
        if self.cfg.enabled:
            self.pub.publish(String(data=f'{self.cfg.message_prefix} #{self.n}'))
            self.n += 1


def main():
    rclpy.init()
    try:
        rclpy.spin(Chatter())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except ValueError as e:
        rclpy.logging.get_logger('parameterized_publisher').fatal(str(e))
        sys.exit(1)
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
