import random

while True:
    print('Temperature on /sensor/temperature is', random.uniform(20.0, 30.0))
