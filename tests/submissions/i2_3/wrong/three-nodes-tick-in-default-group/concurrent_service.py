#! /usr/bin/env python3

# ----- #
import rclpy
import rclpy.logging
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.callback_groups import ReentrantCallbackGroup
# ----- #

from geometry_msgs.msg import Twist
from example_interfaces.srv import AddTwoInts

import time

"""
Listo
Falta probar con el robot
"""


class Navigation(Node):

    def __init__(self):
        super().__init__('navigation_node')
        self.state_nav = 0
        self.start_time = 0.0

    def start_patrol_behavior(self):
        self.state_nav = 1
        self.start_time = time.monotonic()


class FrameListener(Node):

    def __init__(self, navigation_node, namespace=''):
        super().__init__('frame_listener_node', namespace=namespace)
        self.navigation_node_ = navigation_node
        self.timer_on_ = False
        self.listener_timer = self.create_timer(0.02, self.timer_function, ReentrantCallbackGroup())

    def timer_function(self):
        # sin camara: el marco "aparece" a los 3 segundos
        if not self.timer_on_:
            return
        if time.monotonic() - self.navigation_node_.start_time >= 3.0:
            self.get_logger().debug('[frame found]')
            self.navigation_node_.state_nav = 5


class PatrolBehaviorServer(Node):

    """
    Servidor de patrulla: el servicio espera a que la navegacion termine,
    y un temporizador rapido muestra que el nodo sigue vivo.
    """
    def __init__(self, node_name='patrol_behavior_server_node', namespace=''):
        super().__init__(node_name=node_name, namespace=namespace)

        self.navigation_node_ = Navigation()
        self.listener_node_ = FrameListener(self.navigation_node_, namespace='patrol_behavior_server')

        self.declare_parameter('patrol_log_level', 'info')
        log_level = self.get_parameter('patrol_log_level').get_parameter_value().string_value

        self.log_levels = {
            'debug': rclpy.logging.LoggingSeverity.DEBUG,
            'info': rclpy.logging.LoggingSeverity.INFO,
        }
        self.get_logger().set_level(self.log_levels.get(log_level.lower(), rclpy.logging.LoggingSeverity.INFO))

        # Bandera: termino el proceso?
        self.isDone = False
        self.count = 0
        self.publisher_ = self.create_publisher(Twist, 'cmd_vel', 10)

        # Temporizador de 10 Hz
        self.fast_timer = self.create_timer(0.1, self.fast_timer_function)

        # Create Server
        self.srv = self.create_service(AddTwoInts, 'slow_add', self.service_callback)
        self.get_logger().info('patrol_behavior_server_node ready')

    def start(self):
        self.get_logger().debug('[start]')
        self.isDone = False
        self.navigation_node_.start_patrol_behavior()
        self.listener_node_.timer_on_ = True

    def end_process(self):
        self.get_logger().debug('[end_process]')
        self.listener_node_.timer_on_ = False

    def fast_timer_function(self):
        self.count += 1
        if self.count % 10 == 0:
            self.get_logger().info(f'[timer] tick {self.count}')

    def service_callback(self, request, response):

        self.get_logger().info('Server has been called!')
        self.start()

        while self.isDone == False and rclpy.ok():
            if self.navigation_node_.state_nav == 5:
                self.get_logger().info('[SUCCEED]')
                self.isDone = True
                self.end_process()
            time.sleep(0.02)
        response.sum = request.a + request.b
        return response

def main():

    rclpy.init()

    patrol_behavior_node = PatrolBehaviorServer()
    navigation_node = patrol_behavior_node.navigation_node_
    frame_listener_node = patrol_behavior_node.listener_node_

    executor = MultiThreadedExecutor(num_threads=4)

    executor.add_node(patrol_behavior_node)
    executor.add_node(navigation_node)
    executor.add_node(frame_listener_node)

    try:
        print("### Server Patrol Behavior ###")
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        print("Interrumpido, cerrando")
    except Exception as e:
        patrol_behavior_node.get_logger().error(f'Exception caught: {str(e)}')
    finally:
        executor.shutdown()

        patrol_behavior_node.destroy_node()
        navigation_node.destroy_node()
        frame_listener_node.destroy_node()

        rclpy.try_shutdown()

    return None

if __name__ == '__main__':
    main()
