import sys
import rclpy
from example_interfaces.srv import AddTwoInts


def llamar(nodo, servicio, a, b):
    cliente = nodo.create_client(AddTwoInts, servicio)
    if not cliente.wait_for_service(timeout_sec=10.0):
        nodo.get_logger().error(f'{servicio} no está')
        return False
    futuro = cliente.call_async(AddTwoInts.Request(a=a, b=b))
    while not futuro.done():
        rclpy.spin_once(nodo, timeout_sec=0.1)
    nodo.get_logger().info(f'{servicio}: {futuro.result().sum}')
    return True


def main():
    rclpy.init()
    nodo = rclpy.create_node('cliente')
    bien = all([llamar(nodo, s, 42, -7) for s in ('add', 'subtract', 'multiply', 'divide')])
    nodo.destroy_node()
    rclpy.shutdown()
    return 0 if bien else 1


if __name__ == '__main__':
    sys.exit(main())
