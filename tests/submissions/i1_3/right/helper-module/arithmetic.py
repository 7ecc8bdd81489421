class CalculatorError(Exception):
    pass


def divide(a, b):
    if b == 0:
        raise CalculatorError('division by zero')
    return a // b


OPERATIONS = {
    'add': lambda a, b: a + b,
    'subtract': lambda a, b: a - b,
    'multiply': lambda a, b: a * b,
    'divide': divide,
}
