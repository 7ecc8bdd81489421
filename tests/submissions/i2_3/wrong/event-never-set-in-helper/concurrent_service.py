from adder import Adder
from runner import run

if __name__ == '__main__':
    run(Adder)
