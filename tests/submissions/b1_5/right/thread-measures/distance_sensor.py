import threading

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from std_msgs.msg import Float64


class DistanceSensor(LifecycleNode):
    def __init__(self):
        super().__init__("distance_sensor")
        self.declare_parameter("rate", 5.0)
        self.stop = threading.Event()
        self.worker = None
        self.pub = None

    def on_configure(self, state):
        self.period = self.get_parameter("rate").value
        if self.period <= 0:
            return TransitionCallbackReturn.FAILURE
        self.period = 1 / self.period
        self.pub = self.create_publisher(Float64, "distance", 10)
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        self.stop.clear()
        self.worker = threading.Thread(target=self.work, daemon=True)
        self.worker.start()
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state):
        self.stop.set()
        if self.worker:
            self.worker.join()
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state):
        self.destroy_publisher(self.pub)
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state):
        return self.on_deactivate(state)

    def work(self):
        while not self.stop.wait(self.period):
            self.pub.publish(Float64(data=1.9))


def main():
    rclpy.init()
    node = DistanceSensor()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.stop.set()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
