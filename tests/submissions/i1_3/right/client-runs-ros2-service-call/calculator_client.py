"""Calls the services with the ros2 command, as in a terminal."""
import re
import subprocess
import sys

TYPE = 'example_interfaces/srv/AddTwoInts'


def call(name, a, b):
    done = subprocess.run(
        ['ros2', 'service', 'call', f'/{name}', TYPE, f'{{a: {a}, b: {b}}}'],
        capture_output=True, text=True, check=True,
    )
    return int(re.search(r'sum=(-?\d+)', done.stdout).group(1))


def main():
    for name, sign in (('add', '+'), ('subtract', '-'), ('multiply', '*'), ('divide', '/')):
        print(f'8 {sign} 2 = {call(name, 8, 2)}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
