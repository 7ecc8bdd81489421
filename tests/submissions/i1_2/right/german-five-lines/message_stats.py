import time
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Statistik(Node):
    def __init__(self):
        super().__init__("statistik")
        self.create_subscription(String, "/chatter", self.empfangen, 10)
        self.anzahl = 0
        self.erste = self.letzte = None
        self.beginn = None
        self.nummer = None
        self.verloren = 0

    def empfangen(self, nachricht):
        jetzt = time.monotonic()
        if self.anzahl == 0:
            self.beginn, self.erste = jetzt, nachricht.data
        self.anzahl += 1
        self.letzte = nachricht.data
        nummer = int(nachricht.data.split(":")[-1])
        if self.nummer is not None:
            if nummer > self.nummer + 1:
                self.verloren += nummer - self.nummer - 1
        self.nummer = nummer
        if self.anzahl % 10 == 0:
            dauer = jetzt - self.beginn
            rate = f"{(self.anzahl - 1) / dauer:.1f}".replace(".", ",")
            log = self.get_logger()
            log.info("=== Statistik " + "=" * 30)
            log.info(f"  Nachrichten: {self.anzahl}")
            log.info(f"  Rate:        {rate} Nachrichten pro Sekunde")
            log.info(f"  Erste:       „{self.erste}“")
            log.info(f"  Letzte:      „{self.letzte}“")
            log.info(f"  Verloren:    {self.verloren}")
            log.info("=" * 44)


def main():
    rclpy.init()
    knoten = Statistik()
    try:
        rclpy.spin(knoten)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        knoten.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
