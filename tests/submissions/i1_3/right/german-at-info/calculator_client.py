import threading

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException


def spinnen(knoten):
    try:
        rclpy.spin(knoten)
    except ExternalShutdownException:
        pass


def main():
    rclpy.init()
    knoten = rclpy.create_node('kunde')
    faden = threading.Thread(target=spinnen, args=(knoten,), daemon=True)
    faden.start()
    for dienst, a, b in (('add', 1, 2), ('subtract', 1, 2), ('multiply', 3, -4), ('divide', 8, 2), ('divide', 8, 0)):
        kunde = knoten.create_client(AddTwoInts, dienst)
        kunde.wait_for_service()
        antwort = kunde.call(AddTwoInts.Request(a=a, b=b))
        print(f'{dienst}({a}, {b}) ist {antwort.sum}')
    rclpy.shutdown()
    faden.join()


if __name__ == '__main__':
    main()
