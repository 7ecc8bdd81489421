#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from std_msgs.msg import Float64MultiArray
from example_interfaces.srv import AddTwoInts

import csv
import io
import math
import threading
import sys
import termios
import tty
import select
from pathlib import Path

DEFAULT_JOINT_NAMES = ['front_sh', 'front_ank_y', 'rear_sh']

DEMO_CSV = """0,10,-5
5,20,-10
0,10,-5
-5,0,0
"""


class CSVJointTrajectory(Node):
    def __init__(self, csv_path: str | None = None):
        super().__init__('csv_joint_trajectory')

        self.gruppo_servizio = MutuallyExclusiveCallbackGroup()
        self.gruppo_timer = ReentrantCallbackGroup()

        # Publisher
        self.pub = self.create_publisher(Float64MultiArray, '/joint_positions', 10)

        self.declare_parameter('joint_names', DEFAULT_JOINT_NAMES)
        self.joint_names = [str(j) for j in self.get_parameter('joint_names').value]

        # file passato come parametro o come argomento, altrimenti la demo
        self.declare_parameter('csv_path', '')
        scelto = csv_path or self.get_parameter('csv_path').value
        testo = Path(scelto).read_text() if scelto else DEMO_CSV
        self.positions_list = self.load_csv_in_radians(testo, len(self.joint_names))

        self.get_logger().info(f"Joint usati: {self.joint_names}")
        self.get_logger().info(f"Caricate {len(self.positions_list)} pose. Ctrl+C per uscire.")

        self.index = 0
        self.chiamate = 0
        self.lock = threading.Lock()

        # Flag stop per thread
        self._stop_event = threading.Event()

        # Tastiera solo se c'e' davvero un terminale
        self.fd = None
        if sys.stdin is not None and sys.stdin.isatty():
            self.fd = sys.stdin.fileno()
            self.old_term = termios.tcgetattr(self.fd)
            tty.setcbreak(self.fd)
            self.keyboard_thread = threading.Thread(target=self.keyboard_listener, daemon=True)
            self.keyboard_thread.start()

        self.srv = self.create_service(AddTwoInts, 'slow_add', self.somma_lenta,
                                       callback_group=self.gruppo_servizio)
        self.timer = self.create_timer(0.1, self.send_next_point,
                                       callback_group=self.gruppo_timer)

        # alla chiusura di ROS si ferma tutto quello che aspetta
        rclpy.get_default_context().on_shutdown(self.on_shutdown)

    def on_shutdown(self):
        self._stop_event.set()
        if self.fd is None:
            return
        try:
            termios.tcsetattr(self.fd, termios.TCSADRAIN, self.old_term)
        except Exception:
            pass

    def destroy_node(self):
        # vale anche quando si passa da qui per primi
        self.on_shutdown()
        super().destroy_node()

    def load_csv_in_radians(self, testo: str, expected_len: int):
        positions = []
        for row_idx, row in enumerate(csv.reader(io.StringIO(testo)), start=1):
            if not row:
                continue
            if len(row) != expected_len:
                raise ValueError(f"Riga {row_idx}: {len(row)} valori, attesi {expected_len}")
            positions.append([math.radians(float(v)) for v in row])
        return positions

    def getch_nonblocking(self, timeout_s: float = 0.1):
        """Un carattere se arriva in tempo, se no None."""
        dr, _, _ = select.select([sys.stdin], [], [], timeout_s)
        if dr:
            return sys.stdin.read(1)
        return None

    def keyboard_listener(self):
        while rclpy.ok() and not self._stop_event.is_set():
            ch = self.getch_nonblocking(0.1)
            if ch == ' ':
                self.get_logger().info(f"Finora {self.chiamate} chiamate")

    def somma_lenta(self, request, response):
        self.chiamate += 1
        self.get_logger().info(f"Richiesta: {request.a} + {request.b}")
        if self._stop_event.wait(3.0):
            self.get_logger().warn("Chiusura durante il calcolo")
        response.sum = request.a + request.b
        return response

    def send_next_point(self):
        if not self.positions_list:
            self.get_logger().warn("CSV vuoto: nessun punto da inviare.")
            return

        with self.lock:
            positions = self.positions_list[self.index % len(self.positions_list)]
            self.pub.publish(Float64MultiArray(data=positions))
            self.get_logger().info(f"[{self.index}] punto inviato")
            self.index += 1


def main(args=None):
    rclpy.init(args=args)

    node = CSVJointTrajectory()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)

    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        # la pulizia la fa comunque destroy_node
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
