import contextlib

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_msgs.msg import Float64


class DistanceSensor(LifecycleNode):
    def __init__(self):
        super().__init__("distance_sensor")
        self.rate = self.declare_parameter("rate", 5.0)
        self.undo = contextlib.ExitStack()
        self.pub = None

    def on_configure(self, state):
        rate = self.get_parameter("rate").value
        if rate <= 0:
            return TransitionCallbackReturn.ERROR
        qos = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
        self.pub = self.create_lifecycle_publisher(Float64, "distance", qos)
        self.undo.callback(self.destroy_lifecycle_publisher, self.pub)
        timer = self.create_timer(1 / rate, self.send)
        self.undo.callback(self.destroy_timer, timer)
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        return self.pub.on_activate(state)

    def on_deactivate(self, state):
        return self.pub.on_deactivate(state)

    def on_cleanup(self, state):
        self.undo.close()
        return TransitionCallbackReturn.SUCCESS

    on_shutdown = on_cleanup

    def send(self):
        self.pub.publish(Float64(data=2.2))


def main():
    rclpy.init()
    try:
        rclpy.spin(DistanceSensor())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
