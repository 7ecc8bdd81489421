import threading
import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class ThreadPublisher(Node):
    def __init__(self):
        super().__init__('thread_publisher')
        self.cfg = {}
        for name, default in (('message_prefix', 'Hello'), ('publish_rate', 1.0), ('enabled', True)):
            self.cfg[name] = self.declare_parameter(name, default).value
        self.cond = threading.Condition()
        self.stop = False
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.add_on_set_parameters_callback(self.changed)
        self.thread = threading.Thread(target=self.loop)
        self.thread.start()

    def changed(self, params):
        new = {p.name: p.value for p in params if p.name in self.cfg}
        if 'publish_rate' in new and new['publish_rate'] <= 0:
            return SetParametersResult(successful=False, reason='publish_rate <= 0 makes no sense')
        with self.cond:
            self.cfg.update(new)
            if 'publish_rate' in new:
                self.cond.notify()
        return SetParametersResult(successful=True)

    def loop(self):
        n = 0
        with self.cond:
            while not self.stop:
                woken = self.cond.wait(1.0 / self.cfg['publish_rate'])
                if woken or not self.cfg['enabled'] or not rclpy.ok():
                    continue
                self.pub.publish(String(data=f"{self.cfg['message_prefix']} {n}"))
                n += 1


def main():
    rclpy.init()
    node = ThreadPublisher()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        with node.cond:
            node.stop = True
            node.cond.notify()
        node.thread.join()
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
