#!/usr/bin/env python3
# Driver skeleton from our USB thermometer, with the serial port replaced by a fake one.
import random
import threading
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class FakeSerial:
    """Speaks the protocol of the device: one ASCII line 'T=+023.417' per request."""

    def __init__(self, port, baudrate):
        self.port = port
        self.baudrate = baudrate
        self.is_open = True

    def readline(self):
        return ('T=%+08.3f\r\n' % random.uniform(20.0, 30.0)).encode('ascii')

    def close(self):
        self.is_open = False


def parse_line(line):
    text = line.decode('ascii').strip()
    if not text.startswith('T='):
        return None
    # %.3f can never leave the interval here, 20 and 30 have no digits to lose
    return float(text[2:])


class UsbThermometer(Node):
    def __init__(self):
        super().__init__('usb_thermometer')
        self.declare_parameter('sensor_name', 'usb_thermo')
        self.declare_parameter('interval_ms', 1000)
        self.declare_parameter('port', '/dev/ttyUSB0')
        self.declare_parameter('baudrate', 9600)

        self.sensor_name = self.get_parameter('sensor_name').get_parameter_value().string_value
        interval_ms = self.get_parameter('interval_ms').get_parameter_value().integer_value
        self.interval = max(interval_ms, 1) / 1000.0
        self.serial = FakeSerial(self.get_parameter('port').value,
                                 self.get_parameter('baudrate').value)

        self.pub = self.create_publisher(Float64, '/sensor/temperature', 10)
        self.stop_event = threading.Event()
        self.worker = threading.Thread(target=self.poll, daemon=True)
        self.worker.start()
        self.get_logger().info('%s opened on %s, one reading every %d ms'
                               % (self.sensor_name, self.serial.port, interval_ms))

    def poll(self):
        next_time = time.monotonic()
        while not self.stop_event.is_set():
            value = parse_line(self.serial.readline())
            if value is None:
                self.get_logger().warning(self.sensor_name + ': bad line')
            else:
                self.pub.publish(Float64(data=value))
            # absolute schedule, the time publish() takes does not add up
            next_time += self.interval
            self.stop_event.wait(max(0.0, next_time - time.monotonic()))

    def close(self):
        self.stop_event.set()
        self.worker.join(timeout=2.0)
        self.serial.close()


def main(args=None):
    rclpy.init(args=args)
    node = UsbThermometer()
    try:
        rclpy.spin(node)      # only for the parameter services, the worker does the rest
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    node.close()
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
