import rclpy
from abc import ABC
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class CalcDevice(ABC):
    def __init__(self, device_id, node):
        self.device_id = device_id
        self.node = node

        self.srv = node.create_service(AddTwoInts, f'/{device_id}', self.handle_request)

    def handle_request(self, request, response):
        response.sum = self.compute(request.a, request.b)
        self.node.get_logger().info(
            f"✅ {self.device_id}: a={request.a} b={request.b} => {response.sum}"
        )
        return response

    def compute(self, a, b):
        raise NotImplementedError


class Adder(CalcDevice):
    def compute(self, a, b):
        return a + b


class Subtractor(CalcDevice):
    def compute(self, a, b):
        return a - b


class Multiplier(CalcDevice):
    def compute(self, a, b):
        return a * b


class Divider(CalcDevice):
    def handle_request(self, request, response):
        if request.b == 0:
            self.get_logger().error(f"❌ {self.device_id}: b=0, division by zero")
            response.sum = 0
            return response
        return super().handle_request(request, response)

    def compute(self, a, b):
        return a // b


class CalcManagerNode(Node):
    def __init__(self):
        super().__init__('calc_manager_node')

        # Instead of "self.services = []", name it something else:
        self._calc_devices = [
            Adder('add', self),
            Subtractor('subtract', self),
            Multiplier('multiply', self),
            Divider('divide', self),
        ]
        self.get_logger().info(f"{len(self._calc_devices)} devices initialized")


def main(args=None):
    rclpy.init(args=args)
    node = CalcManagerNode()
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
