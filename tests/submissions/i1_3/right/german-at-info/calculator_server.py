import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Rechner(Node):
    def __init__(self):
        super().__init__('rechner')
        for dienst, funktion in (('add', self.plus), ('subtract', self.minus),
                                 ('multiply', self.mal), ('divide', self.geteilt)):
            self.create_service(AddTwoInts, dienst, funktion)

    def plus(self, anfrage, antwort):
        antwort.sum = anfrage.a + anfrage.b
        return antwort

    def minus(self, anfrage, antwort):
        antwort.sum = anfrage.a - anfrage.b
        return antwort

    def mal(self, anfrage, antwort):
        antwort.sum = anfrage.a * anfrage.b
        return antwort

    def geteilt(self, anfrage, antwort):
        if anfrage.b == 0:
            self.get_logger().info('Fehler: Division durch null ist nicht erlaubt')
        else:
            antwort.sum = anfrage.a // anfrage.b
        return antwort


def main():
    rclpy.init()
    rechner = Rechner()
    try:
        rclpy.spin(rechner)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rechner.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
