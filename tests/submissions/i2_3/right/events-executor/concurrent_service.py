import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.task import Future


class Service(Node):
    def __init__(self):
        super().__init__('service_concurrent')
        self.cbg = ReentrantCallbackGroup()
        self.compteur = 0
        self.create_service(AddTwoInts, 'slow_add', self.addition, callback_group=self.cbg)
        self.create_timer(0.1, self.minuterie, callback_group=self.cbg)

    def minuterie(self):
        self.compteur += 1
        if self.compteur % 10 == 0:
            self.get_logger().info('Minuterie 10 Hz')
            self.get_logger().info(f'  battement n° {self.compteur}')

    async def addition(self, requete, reponse):
        attente = Future()
        minuteur = self.create_timer(3.0, lambda: attente.set_result(True), callback_group=self.cbg)
        await attente
        minuteur.destroy()
        reponse.sum = requete.a + requete.b
        return reponse


def main():
    rclpy.init()
    noeud = Service()
    executeur = EventsExecutor()
    executeur.add_node(noeud)
    try:
        executeur.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
