#!/usr/bin/env python3
# -*- coding: utf-8 -*-
#
# Node de service lent - projet robot mobile, S7
#
import threading

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

from example_interfaces.srv import AddTwoInts


class ServiceConcurrent(Node):
    """Service lent + timer rapide."""

    DUREE = 3.0

    def __init__(self):
        super().__init__('service_concurrent')

        # tant que l'evenement est mis, le noeud tourne
        self.en_marche = threading.Event()
        self.en_marche.set()

        self.groupe_service = ReentrantCallbackGroup()
        self.groupe_timer = ReentrantCallbackGroup()

        self.service = self.create_service(AddTwoInts, 'slow_add', self.cb_addition,
                                           callback_group=self.groupe_service)
        self.nb = 0
        self.timer = self.create_timer(0.1, self.cb_timer, callback_group=self.groupe_timer)

    def cb_addition(self, requete, reponse):
        self.get_logger().info(f'Demande : {requete.a} + {requete.b}')
        # mieux que time.sleep : on se reveille si le noeud s'arrete
        self.en_marche.wait(self.DUREE)
        reponse.sum = requete.a + requete.b
        self.get_logger().info(f'Resultat : {reponse.sum}')
        return reponse

    def cb_timer(self):
        self.nb += 1
        if self.nb % 10 == 0:
            self.get_logger().info(f'Timer : {self.nb}')

    def arreter(self):
        self.en_marche.clear()


def main(args=None):
    rclpy.init(args=args)
    noeud = ServiceConcurrent()
    executeur = MultiThreadedExecutor(num_threads=6)
    executeur.add_node(noeud)
    try:
        executeur.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        print('Arret demande')
    finally:
        noeud.arreter()
        noeud.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
