#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64
import math
import random #importando bibliotecas para o calculo da temperatura


class TemperaturePublisherNode(Node):
    def __init__(self):
        super().__init__("temperature_publisher")
        #declarando os parametros
        self.declare_parameter("sensor_name", "estufa")
        self.declare_parameter("publish_frequency", 2.0)
        self.declare_parameter("max_std", 1.5)

        self.sensor_name_ = self.get_parameter("sensor_name")
        self.publish_frequency_ = self.get_parameter("publish_frequency").value
        self.max_std_ = self.get_parameter("max_std").value

        self.readings_ = [] #lista para armazenar as ultimas leituras
        self.publisher = self.create_publisher(Float64, "/sensor/temperature", 10) #criando um publisher para o topico do tipo Float64
        self.timer_ = self.create_timer(1.0 / self.publish_frequency_, self.publish_temperature)
        self.get_logger().info(f"{self.sensor_name_}: Temperature Publisher has been started!")

    def std(self): #desvio padrao das ultimas leituras
        n = len(self.readings_)
        avg = sum(self.readings_) / n
        return math.sqrt(sum((t - avg) ** 2 for t in self.readings_) / n)

    def publish_temperature(self): #funcao para publicar a temperatura
        temperature = random.uniform(20.0, 30.0)
        self.readings_.append(temperature)
        if len(self.readings_) > 20:
            self.readings_.pop(0)

        msg = Float64() #variavel msg do tipo Float64
        msg.data = temperature #o dado dessa mensagem eh a temperatura
        self.publisher.publish(msg) #publicando a mensagem (temperatura)

        self.get_logger().info(f"{self.sensor_name_}: {temperature:.3f} C")
        if self.std() > self.max_std_:
            self.get_logger().debug(f"{self.sensor_name_}: std {self.std():.3f}")


def main(args=None):
    rclpy.init(args=args)
    node = TemperaturePublisherNode()
    rclpy.spin(node)
    rclpy.shutdown()


if __name__ == "__main__":
    main()
