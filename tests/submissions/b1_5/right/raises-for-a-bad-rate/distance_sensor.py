import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from std_msgs.msg import Float64


class DistanceSensor(LifecycleNode):
    def __init__(self):
        super().__init__("distance_sensor")
        self.declare_parameter("rate", 5.0)

    def on_configure(self, state):
        rate = self.get_parameter("rate").value
        if rate <= 0:
            raise ValueError(f"rate must be above 0, not {rate}")
        self.out = self.create_lifecycle_publisher(Float64, "distance", 10)
        self.tick = self.create_timer(1 / rate, self.publish)
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, state):
        self.get_logger().error("could not be configured: look at the rate")
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state):
        self.destroy_timer(self.tick)
        self.destroy_lifecycle_publisher(self.out)
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state):
        return super().on_deactivate(state)

    def publish(self):
        self.out.publish(Float64(data=1.1))


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
