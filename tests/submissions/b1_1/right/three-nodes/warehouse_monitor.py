import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy
from std_msgs.msg import Int32, String


class Listener(Node):
    kind, topic, qos = String, "", QoSProfile(depth=10)

    def __init__(self):
        super().__init__(f"{self.topic}_listener")
        self.create_subscription(self.kind, self.topic, self.listen, self.qos)

    def listen(self, message):
        self.get_logger().info(str(message.data))


class MapListener(Listener):
    topic = "map"
    qos = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)


class RangeListener(Listener):
    kind = Int32
    topic = "range"
    qos = QoSProfile(depth=10, reliability=QoSReliabilityPolicy.BEST_EFFORT)


class ParcelListener(Listener):
    topic = "parcels"
    qos = QoSProfile(depth=250)


def main():
    rclpy.init()
    executor = SingleThreadedExecutor()
    for listener in (MapListener, RangeListener, ParcelListener):
        executor.add_node(listener())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
