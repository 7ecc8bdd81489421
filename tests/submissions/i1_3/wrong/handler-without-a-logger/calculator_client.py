import threading

import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class CalcSimulationNode(Node):
    """Sends one request to each device and collects the answers."""

    def __init__(self):
        super().__init__('calc_simulation_node')
        self._calc_clients = {}
        self.results = {}
        self.all_done = threading.Event()

        for device_id in ('add', 'subtract', 'multiply', 'divide'):
            cli = self.create_client(AddTwoInts, f'/{device_id}')
            while not cli.wait_for_service(timeout_sec=1.0):
                self.get_logger().info(f'waiting for {device_id}')
            self._calc_clients[device_id] = cli

    def send(self, device_id, a, b):
        req = AddTwoInts.Request()
        req.a = a
        req.b = b
        future = self._calc_clients[device_id].call_async(req)

        def handle_response(fut):
            self.results[device_id] = fut.result().sum
            self.get_logger().info(f"✅ {device_id}: {a}, {b} => {fut.result().sum}")
            if len(self.results) == len(self._calc_clients):
                self.all_done.set()

        future.add_done_callback(handle_response)


def main(args=None):
    rclpy.init(args=args)
    node = CalcSimulationNode()
    for device_id in node._calc_clients:
        node.send(device_id, 50, 10)

    while rclpy.ok() and not node.all_done.is_set():
        rclpy.spin_once(node, timeout_sec=0.1)

    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
