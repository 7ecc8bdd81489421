import random

import rclpy
from rclpy.node import Node


class FakeSocket:
    """Stands in for the TCP sensor, sends a status line each time it is asked"""

    def __init__(self):
        self.open = False

    def connect(self, address):
        self.open = True

    def sendall(self, data):
        pass

    def recv(self, size):
        temp = int(random.uniform(2000, 3000))
        return f"$11{temp:04X}\r\n".encode()

    def close(self):
        self.open = False


class SensorNode(Node):
    def __init__(self):
        super().__init__('temperature_publisher')

        self.declare_parameter('interval', 1000)
        self.declare_parameter('sensor_name', 'imu_box')

        self.sensor_ip = '172.20.10.2'  # not used with the fake socket
        self.sensor_port = 2000
        self.socket = FakeSocket()
        self.socket.connect((self.sensor_ip, self.sensor_port))

        self.temp_pub = self.create_publisher(float, '/sensor/temperature', 10)

        interval = self.get_parameter('interval').value
        self.timer = self.create_timer(interval / 1000.0, self.receive_message)

        self.send_start_command()

    def send_start_command(self):
        command_id = '03'
        interval = self.get_parameter('interval').value
        message = f"#{command_id}{interval:04x}\r\n"
        self.socket.sendall(message.encode())
        self.get_logger().info(f"Sent start command with interval: {interval} ms")

    def handle_stop_command(self):
        self.socket.sendall("#09\r\n".encode())
        self.get_logger().info("Sent stop command")
        self.timer.cancel()

    def receive_message(self):
        try:
            response = self.socket.recv(1024).decode()
            if response.startswith('$11'):
                self.handle_status_message(response)
        except OSError as e:
            self.get_logger().error(f"Socket error: {e}")

    def handle_status_message(self, response):
        payload = response[3:-2]
        try:
            env_temp = int(payload[0:4], 16) / 100.0

            self.temp_pub.publish(env_temp)

            sensor_name = self.get_parameter('sensor_name').value
            self.get_logger().info(f"Status of {sensor_name}: Temp={env_temp}")
        except ValueError as e:
            self.get_logger().error(f"Error decoding message: {e}")


def main(args=None):
    rclpy.init(args=args)
    node = SensorNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.socket.close()
        node.destroy_node()
        rclpy.shutdown()


if __name__ == '__main__':
    main()
