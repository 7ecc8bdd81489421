import threading

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from std_msgs.msg import Float64


class DistanceSensor(LifecycleNode):
    def __init__(self) -> None:
        super().__init__("distance_sensor")
        self.declare_parameter("rate", 5.0)
        self.lock = threading.Lock()
        self.group = ReentrantCallbackGroup()
        self.sender = None
        self.ticker = None

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        rate = self.get_parameter("rate").value
        if rate <= 0:
            return TransitionCallbackReturn.FAILURE
        with self.lock:
            self.sender = self.create_lifecycle_publisher(Float64, "distance", 10)
            self.ticker = self.create_timer(1 / rate, self.tick, callback_group=self.group)
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        with self.lock:
            self.destroy_timer(self.ticker)
            self.destroy_lifecycle_publisher(self.sender)
            self.sender = None
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        with self.lock:
            if self.sender is not None:
                self.destroy_timer(self.ticker)
                self.destroy_lifecycle_publisher(self.sender)
                self.sender = None
        return TransitionCallbackReturn.SUCCESS

    def tick(self) -> None:
        with self.lock:
            if self.sender is not None:
                self.sender.publish(Float64(data=0.7))


def main() -> None:
    rclpy.init()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(DistanceSensor())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
