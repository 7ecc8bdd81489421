from my_sensor import TemperaturePublisher
from my_util import run

if __name__ == '__main__':
    run(TemperaturePublisher)
