import rclpy
from rclpy.node import Node
from rcl_interfaces.msg import ParameterDescriptor, ParameterType, SetParametersResult
from std_msgs.msg import String


class ParameterGenerator:
    """Collects parameters and declares them all at once (like dynamic_reconfigure)."""

    def __init__(self):
        self.param_cache = []

    def add(self, param_name, default, description=None, read_only=True):
        descriptor = ParameterDescriptor()
        descriptor.name = param_name
        descriptor.description = description or param_name
        descriptor.read_only = read_only
        descriptor.type = {
            bool: ParameterType.PARAMETER_BOOL,
            float: ParameterType.PARAMETER_DOUBLE,
            str: ParameterType.PARAMETER_STRING,
        }[type(default)]
        self.param_cache.append((param_name, default, descriptor))

    def declare_params(self, node):
        for param in self.param_cache:
            node.declare_parameter(*param)


gen = ParameterGenerator()
gen.add('message_prefix', 'Hello', 'Text in front of the counter')
gen.add('publish_rate', 1.0, 'Rate of the messages [Hz]', read_only=False)
gen.add('enabled', True, 'Publish at all?', read_only=False)


class ChatterPublisher(Node):
    def __init__(self):
        super().__init__('chatter_publisher')
        gen.declare_params(self)
        self.config = {p[0]: self.get_parameter(p[0]).value for p in gen.param_cache}
        self.publisher = self.create_publisher(String, 'chatter', 1)
        self.number = 0
        self.loop = self.create_timer(1 / self.config['publish_rate'], self.step)
        self.add_on_set_parameters_callback(self.reconfigure)

    def reconfigure(self, parameters):
        for parameter in parameters:
            if parameter.name == 'publish_rate' and parameter.value <= 0:
                return SetParametersResult(successful=False, reason='publish_rate: only rates above 0 Hz')
        for parameter in parameters:
            self.config[parameter.name] = parameter.value
            if parameter.name == 'publish_rate':
                self.destroy_timer(self.loop)
                self.loop = self.create_timer(1 / parameter.value, self.step)
        return SetParametersResult(successful=True)

    def step(self):
        if self.config['enabled']:
            self.publisher.publish(String(data=self.config['message_prefix'] + ' ' + str(self.number)))
            self.number += 1


def main():
    rclpy.init(args=None)
    node = ChatterPublisher()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
