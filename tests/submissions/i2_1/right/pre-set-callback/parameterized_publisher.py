import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import String


class Sprecher(Node):
    def __init__(self):
        super().__init__('sprecher')
        self.zaehler = 0
        self.uhr = None
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('enabled', True)
        self.declare_parameter('publish_rate', 1.0)
        self.add_pre_set_parameters_callback(self.aufraeumen)
        self.add_on_set_parameters_callback(self.pruefen)
        self.add_post_set_parameters_callback(self.anwenden)
        self.ausgang = self.create_publisher(String, 'chatter', 10)
        takt = self.get_parameter('publish_rate').value
        if takt <= 0:
            self.get_logger().warning(f'publish_rate={takt} ist ungültig, nehme 1.0')
            self.set_parameters([Parameter('publish_rate', value=1.0)])
        else:
            self.uhr_stellen(takt)

    def uhr_stellen(self, takt):
        if self.uhr is not None:
            self.uhr.destroy()
        self.uhr = self.create_timer(1.0 / takt, self.senden)

    def aufraeumen(self, liste):
        return [Parameter(p.name, value=p.value.strip()) if p.name == 'message_prefix' else p for p in liste]

    def pruefen(self, liste):
        for p in liste:
            if p.name == 'publish_rate' and p.value <= 0:
                self.get_logger().error('abgelehnt')
                return SetParametersResult(successful=False, reason='Der Takt muss größer als null sein')
        return SetParametersResult(successful=True)

    def anwenden(self, liste):
        for p in liste:
            if p.name == 'publish_rate':
                self.uhr_stellen(p.value)

    def senden(self):
        if self.get_parameter('enabled').value:
            self.zaehler += 1
            vorsilbe = self.get_parameter('message_prefix').value
            self.ausgang.publish(String(data=f'{vorsilbe} Nr. {self.zaehler}'))


def main():
    rclpy.init()
    knoten = Sprecher()
    try:
        rclpy.spin(knoten)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        knoten.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
