import rclpy
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn as Ret
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64


class DistanceSensor(LifecycleNode):
    def __init__(self):
        super().__init__("distance_sensor")
        self.declare_parameter("rate", 5.0)
        self.pub = None
        self.tmr = None
        self.active = False

    def on_configure(self, state):
        rate = self.get_parameter("rate").value
        if rate <= 0:
            self.get_logger().error("bad rate")
            return Ret.FAILURE
        self.pub = self.create_publisher(Float64, "/distance", 1)
        self.tmr = self.create_timer(1.0 / rate, self.tick)
        return Ret.SUCCESS

    def on_activate(self, state):
        self.active = True
        return Ret.SUCCESS

    def on_deactivate(self, state):
        self.active = False
        return Ret.SUCCESS

    def on_cleanup(self, state):
        self.tmr.cancel()
        self.destroy_timer(self.tmr)
        self.destroy_publisher(self.pub)
        return Ret.SUCCESS

    def on_shutdown(self, state):
        self.active = False
        return Ret.SUCCESS

    def tick(self):
        if self.active:
            self.pub.publish(Float64(data=1.0))


def main():
    rclpy.init()
    node = DistanceSensor()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


main()
