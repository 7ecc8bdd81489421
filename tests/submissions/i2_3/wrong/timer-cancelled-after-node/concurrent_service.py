#!/usr/bin/env python3
import sys
import time
from threading import Lock

import rclpy
from rclpy.node import Node
from rclpy.executors import MultiThreadedExecutor, ExternalShutdownException
from rclpy.callback_groups import ReentrantCallbackGroup

from example_interfaces.srv import AddTwoInts


class PumpeKnoten(Node):
    """Simulierte Pumpe: Befehle dauern 3 Sekunden, Status mit 10 Hz."""

    def __init__(self):
        super().__init__('pumpe')
        self._lock = Lock()
        self._aktiv = 0
        self.zaehler = 0
        gruppe_befehl = ReentrantCallbackGroup()
        gruppe_status = ReentrantCallbackGroup()
        self.dienst = self.create_service(AddTwoInts, 'slow_add', self.befehl,
                                          callback_group=gruppe_befehl)
        self.status_timer = self.create_timer(0.1, self.status, callback_group=gruppe_status)

    def befehl(self, anfrage, antwort):
        with self._lock:
            self._aktiv += 1
        self.get_logger().info('Befehl angenommen')
        time.sleep(3.0)
        antwort.sum = anfrage.a + anfrage.b
        with self._lock:
            self._aktiv -= 1
        self.get_logger().info('Befehl fertig')
        return antwort

    def status(self):
        self.zaehler += 1
        if self.zaehler % 10 == 0:
            self.get_logger().info('Status %d' % self.zaehler)

    def aufraeumen(self):
        """Alles freigeben, in umgekehrter Reihenfolge."""
        self.status_timer.cancel()
        self.destroy_timer(self.status_timer)
        self.destroy_service(self.dienst)


def main(argv=None):
    rclpy.init(args=argv)
    pumpe = PumpeKnoten()
    executor = MultiThreadedExecutor(num_threads=6)
    executor.add_node(pumpe)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass

    executor.remove_node(pumpe)
    pumpe.destroy_node()
    pumpe.aufraeumen()
    rclpy.try_shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
