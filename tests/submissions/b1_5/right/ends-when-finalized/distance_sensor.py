import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from std_msgs.msg import Float64


class DistanceSensor(LifecycleNode):
    def __init__(self):
        super().__init__("distance_sensor")
        self.finished = rclpy.task.Future()
        self.declare_parameter("rate", 5.0)
        self.add_on_set_parameters_callback(self.check)

    def check(self, parameters):
        bad = [p for p in parameters if p.name == "rate" and p.value < 0]
        return SetParametersResult(successful=not bad, reason="rate must not be negative" if bad else "")

    def on_configure(self, state):
        self.hz = self.get_parameter("rate").value
        if self.hz <= 0:
            return TransitionCallbackReturn.FAILURE
        self.pub = self.create_lifecycle_publisher(Float64, "distance", 10)
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        result = super().on_activate(state)
        self.measure()
        self.timer = self.create_timer(1 / self.hz, self.measure)
        return result

    def on_deactivate(self, state):
        self.timer.destroy()
        self.destroy_timer(self.timer)
        return super().on_deactivate(state)

    def on_cleanup(self, state):
        self.destroy_lifecycle_publisher(self.pub)
        return super().on_cleanup(state)

    def on_shutdown(self, state):
        self.get_logger().info("good bye")
        self.create_timer(0.1, lambda: self.finished.set_result(None))
        return super().on_deactivate(state)

    def measure(self):
        self.pub.publish(Float64(data=4.0))


def main():
    rclpy.init()
    node = DistanceSensor()
    try:
        rclpy.spin_until_future_complete(node, node.finished)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
