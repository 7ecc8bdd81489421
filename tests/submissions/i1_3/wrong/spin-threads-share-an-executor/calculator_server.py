import threading

import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class OperationServer(Node):
    """Basis fuer alle Rechenknoten: ein Knoten, ein Dienst."""

    dienst = None

    def __init__(self):
        super().__init__(self.dienst + '_server')
        self.srv = self.create_service(AddTwoInts, self.dienst, self.callback)
        self.get_logger().info('Dienst /%s bereit' % self.dienst)

    def callback(self, request, response):
        response.sum = self.rechne(request.a, request.b)
        self.get_logger().info('%s(%d, %d) = %d' % (self.dienst, request.a, request.b, response.sum))
        return response

    def rechne(self, a, b):
        raise NotImplementedError


class AddServer(OperationServer):
    dienst = 'add'

    def rechne(self, a, b):
        return a + b


class SubtractServer(OperationServer):
    dienst = 'subtract'

    def rechne(self, a, b):
        return a - b


class MultiplyServer(OperationServer):
    dienst = 'multiply'

    def rechne(self, a, b):
        return a * b


class DivideServer(OperationServer):
    dienst = 'divide'

    def rechne(self, a, b):
        if b == 0:
            self.get_logger().error('FEHLER: Division durch Null (division by zero)')
            return 0
        return a // b


def main():
    rclpy.init()
    knoten = [AddServer(), SubtractServer(), MultiplyServer(), DivideServer()]

    # jeder Knoten bekommt seinen eigenen Thread, damit sich die Dienste nicht blockieren
    threads = []
    for k in knoten:
        t = threading.Thread(target=rclpy.spin, args=(k,), daemon=True)
        t.start()
        threads.append(t)

    try:
        for t in threads:
            t.join()
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
