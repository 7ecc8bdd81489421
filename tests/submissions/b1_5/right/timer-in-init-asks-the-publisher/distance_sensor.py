import random

import rclpy
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from std_msgs.msg import Float64


class DistanceSensor(LifecycleNode):
    def __init__(self):
        super().__init__("distance_sensor")
        self.declare_parameter("rate", 5.0)
        self.range_pub = None
        self.beat = self.create_timer(1.0, self.on_beat)

    def on_configure(self, previous_state):
        hz = self.get_parameter("rate").value
        if not hz > 0.0:
            self.get_logger().fatal(f"cannot measure {hz} times a second")
            return TransitionCallbackReturn.FAILURE
        self.beat.timer_period_ns = int(1e9 / hz)
        self.beat.reset()
        self.range_pub = self.create_lifecycle_publisher(Float64, "distance", qos_profile=5)
        return super().on_configure(previous_state)

    def on_cleanup(self, previous_state):
        answer = super().on_cleanup(previous_state)
        self.destroy_lifecycle_publisher(self.range_pub)
        self.range_pub = None
        return answer

    def on_shutdown(self, previous_state):
        self.beat.cancel()
        return super().on_shutdown(previous_state)

    def on_beat(self):
        if self.range_pub and self.range_pub.is_activated:
            self.range_pub.publish(Float64(data=random.gauss(2.0, 0.1)))


if __name__ == "__main__":
    rclpy.init()
    try:
        rclpy.spin(DistanceSensor())
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass
