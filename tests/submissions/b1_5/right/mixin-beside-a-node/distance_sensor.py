import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import LifecycleNodeMixin, TransitionCallbackReturn
from rclpy.node import Node
from std_msgs.msg import Float64

OK, NO = TransitionCallbackReturn.SUCCESS, TransitionCallbackReturn.FAILURE


class Sensor(Node):
    def __init__(self, name):
        Node.__init__(self, name)
        self.declare_parameter("rate", 5.0)


class DistanceSensor(LifecycleNodeMixin, Sensor):
    def __init__(self):
        Sensor.__init__(self, "distance_sensor")
        LifecycleNodeMixin.__init__(self)
        self.held = []

    def on_configure(self, state):
        rate = self.get_parameter("rate").value
        if rate <= 0:
            return NO
        pub = self.create_lifecycle_publisher(Float64, "distance", 10)
        timer = self.create_timer(1 / rate, lambda: pub.publish(Float64(data=0.5)))
        self.held = [(self.destroy_timer, timer), (self.destroy_lifecycle_publisher, pub)]
        return OK

    def let_go(self, state):
        for destroy, thing in self.held:
            destroy(thing)
        self.held.clear()
        return OK

    on_cleanup = on_shutdown = let_go


def main(args=None):
    rclpy.init(args=args)
    try:
        rclpy.spin(DistanceSensor())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
