import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String

from settings_node import SettingsNode


class ParameterizedPublisher(SettingsNode):
    SETTINGS = {"message_prefix": "Hello", "publish_rate": 1.0, "enabled": True}

    def __init__(self):
        super().__init__("parameterized_publisher")
        self.number: int = 0
        self.publisher = self.create_publisher(String, "chatter", 10)
        self.timer = self.create_timer(1.0 / self.setting("publish_rate"), self.tick)
        self.add_on_set_parameters_callback(self.check)
        self.add_post_set_parameters_callback(self.apply)

    def check(self, changes):
        for change in changes:
            if change.name == "publish_rate" and change.value <= 0.0:
                return SetParametersResult(successful=False, reason="publish_rate has to be above zero")
        return SetParametersResult(successful=True)

    def apply(self, changes):
        for change in changes:
            if change.name == "publish_rate":
                self.timer.cancel()
                self.timer = self.create_timer(1.0 / change.value, self.tick)

    def tick(self):
        if self.setting("enabled"):
            text = "%s %d" % (self.setting("message_prefix"), self.number)
            self.publisher.publish(String(data=text))
            self.number += 1


def main():
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
