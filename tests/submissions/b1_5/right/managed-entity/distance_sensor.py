import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import LifecycleNode, ManagedEntity, TransitionCallbackReturn
from std_msgs.msg import Float64

SUCCESS = TransitionCallbackReturn.SUCCESS


class Ranger(ManagedEntity):
    def __init__(self, node):
        self.node = node
        self.publisher = None
        self.timer = None

    def on_configure(self, state):
        self.rate = self.node.get_parameter("rate").value
        if self.rate <= 0.0:
            return TransitionCallbackReturn.FAILURE
        self.publisher = self.node.create_publisher(Float64, "distance", 10)
        return SUCCESS

    def on_activate(self, state):
        self.timer = self.node.create_timer(1.0 / self.rate, self.measure)
        return SUCCESS

    def on_deactivate(self, state):
        self.node.destroy_timer(self.timer)
        self.timer = None
        return SUCCESS

    def on_cleanup(self, state):
        self.node.destroy_publisher(self.publisher)
        return SUCCESS

    def on_shutdown(self, state):
        if self.timer:
            self.node.destroy_timer(self.timer)
        return SUCCESS

    def measure(self):
        self.publisher.publish(Float64(data=3.0))


def main():
    rclpy.init()
    node = LifecycleNode("distance_sensor")
    node.declare_parameter("rate", 5.0)
    node.add_managed_entity(Ranger(node))
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
