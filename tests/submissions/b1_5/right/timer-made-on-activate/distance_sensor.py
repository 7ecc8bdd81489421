import rclpy
from rclpy.lifecycle import Node, Publisher, State, TransitionCallbackReturn
from rclpy.timer import Timer
from typing import Optional

import std_msgs.msg


class DistanceSensor(Node):
    def __init__(self, node_name, **kwargs):
        self._pub: Optional[Publisher] = None
        self._timer: Optional[Timer] = None
        super().__init__(node_name, **kwargs)
        self.declare_parameter("rate", 5.0)

    def measure(self):
        msg = std_msgs.msg.Float64()
        msg.data = 1.25
        if self._pub is None or not self._pub.is_activated:
            self.get_logger().info("Lifecycle publisher is inactive. Messages are not published.")
        else:
            self.get_logger().info(f"Lifecycle publisher is active. Publishing: [{msg.data}]")
        if self._pub is not None:
            self._pub.publish(msg)

    def on_configure(self, state: State) -> TransitionCallbackReturn:
        self._rate = self.get_parameter("rate").get_parameter_value().double_value
        if self._rate <= 0.0:
            return TransitionCallbackReturn.FAILURE
        self._pub = self.create_lifecycle_publisher(std_msgs.msg.Float64, "distance", 10)
        self.get_logger().info("on_configure() is called.")
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        self._timer = self.create_timer(1 / self._rate, self.measure)
        return super().on_activate(state)

    def on_deactivate(self, state: State) -> TransitionCallbackReturn:
        self.destroy_timer(self._timer)
        return super().on_deactivate(state)

    def on_cleanup(self, state: State) -> TransitionCallbackReturn:
        self.destroy_publisher(self._pub)
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: State) -> TransitionCallbackReturn:
        if self._timer is not None:
            self.destroy_timer(self._timer)
        if self._pub is not None:
            self.destroy_publisher(self._pub)
        return TransitionCallbackReturn.SUCCESS


def main():
    rclpy.init()
    executor = rclpy.executors.SingleThreadedExecutor()
    lc_node = DistanceSensor("distance_sensor")
    executor.add_node(lc_node)
    try:
        executor.spin()
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        lc_node.destroy_node()


if __name__ == "__main__":
    main()
