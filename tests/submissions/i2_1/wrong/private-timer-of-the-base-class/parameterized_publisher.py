import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String

from ticking import TickingNode


class ParameterizedPublisher(TickingNode):
    def __init__(self) -> None:
        super().__init__("parameterized_publisher")
        self.__timer = None
        self.__count = 0
        self.declare_parameter("message_prefix", "Hello")
        self.declare_parameter("enabled", True)
        self.__publisher = self.create_publisher(String, "chatter", 10)
        self.add_on_set_parameters_callback(self.__check)
        self.add_post_set_parameters_callback(self.__retime)

    def __check(self, params) -> SetParametersResult:
        bad = [each.value for each in params if each.name == "publish_rate" and each.value <= 0.0]
        reason = f"publish_rate of {bad[0]} is not positive" if bad else ""
        return SetParametersResult(successful=not bad, reason=reason)

    def __retime(self, params) -> None:
        for each in params:
            if each.name == "publish_rate":
                if self.__timer is not None:
                    self.__timer.cancel()
                self.__timer = self.create_timer(1.0 / each.value, self.tick)

    def tick(self) -> None:
        if self.get_parameter("enabled").value:
            prefix = self.get_parameter("message_prefix").value
            self.__publisher.publish(String(data=f"{prefix} {self.__count}"))
            self.__count += 1


def main() -> None:
    rclpy.init()
    node = ParameterizedPublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
