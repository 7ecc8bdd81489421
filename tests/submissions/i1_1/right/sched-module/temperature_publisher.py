# estação meteorológica de brinquedo - aula 4
#
# Não usei create_timer: já conhecia o módulo sched do Python e queria ver
# se dava certo. Enquanto espera a próxima medida o agendador "dorme" dentro
# do spin_once, assim o nó continua respondendo (ros2 param list etc).
#
#   python3 temperature_publisher.py --ros-args -p taxa_hz:=5.0 -p nome_do_sensor:=telhado
import random
import sched
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64

TOPICO = '/sensor/temperature'
MINIMA, MAXIMA = 20.0, 30.0


def sorteia():
    """Temperatura entre MINIMA e MAXIMA, com duas casas."""
    return round(random.uniform(MINIMA, MAXIMA), 2)


def main():
    rclpy.init()
    no = rclpy.create_node('estacao')
    log = no.get_logger()

    nome = no.declare_parameter('nome_do_sensor', 'estacao-01').value
    taxa = no.declare_parameter('taxa_hz', 2.0).value
    if taxa <= 0.0:
        log.error(f'taxa_hz tem que ser positiva, veio {taxa}; usando 2.0')
        taxa = 2.0
    periodo = 1.0 / taxa

    pub = no.create_publisher(Float64, TOPICO, 10)
    agenda = sched.scheduler(time.monotonic, lambda s: rclpy.spin_once(no, timeout_sec=s))

    def medir(quando):
        msg = Float64()
        msg.data = sorteia()
        pub.publish(msg)
        log.info(f'[{nome}] {msg.data:.2f} graus')
        # hora absoluta, para não acumular atraso
        agenda.enterabs(quando + periodo, 1, medir, (quando + periodo,))

    log.info(f'{nome}: medindo a cada {periodo:.2f} s em {TOPICO}')
    inicio = time.monotonic() + periodo
    agenda.enterabs(inicio, 1, medir, (inicio,))
    try:
        agenda.run()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        no.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
