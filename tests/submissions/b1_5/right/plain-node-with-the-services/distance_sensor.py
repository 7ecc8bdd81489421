import rclpy
from lifecycle_msgs.msg import State, Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64

NAMES = {1: "unconfigured", 2: "inactive", 3: "active", 4: "finalized"}
TABLE = {
    (1, Transition.TRANSITION_CONFIGURE): 2,
    (2, Transition.TRANSITION_CLEANUP): 1,
    (2, Transition.TRANSITION_ACTIVATE): 3,
    (3, Transition.TRANSITION_DEACTIVATE): 2,
    (1, Transition.TRANSITION_UNCONFIGURED_SHUTDOWN): 4,
    (2, Transition.TRANSITION_INACTIVE_SHUTDOWN): 4,
    (3, Transition.TRANSITION_ACTIVE_SHUTDOWN): 4,
}


class DistanceSensor(Node):
    def __init__(self):
        super().__init__("distance_sensor")
        self.declare_parameter("rate", 5.0)
        self.where = State.PRIMARY_STATE_UNCONFIGURED
        self.create_service(ChangeState, "~/change_state", self.change)
        self.create_service(GetState, "~/get_state", self.tell)

    def tell(self, request, response):
        response.current_state = State(id=self.where, label=NAMES[self.where])
        return response

    def change(self, request, response):
        goal = TABLE.get((self.where, request.transition.id))
        if goal is None:
            response.success = False
            return response
        rate = self.get_parameter("rate").value
        if (self.where, goal) == (1, 2):
            if rate <= 0:
                self.get_logger().error(f"rate {rate}?")
                response.success = False
                return response
            self.pub = self.create_publisher(Float64, "distance", 10)
        elif goal == 3:
            self.clock_tick = self.create_timer(1 / rate, lambda: self.pub.publish(Float64(data=2.0)))
        if self.where == 3:
            self.destroy_timer(self.clock_tick)
        if goal == 1:
            self.destroy_publisher(self.pub)
        self.where = goal
        response.success = True
        return response


def main():
    rclpy.init()
    node = DistanceSensor()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
