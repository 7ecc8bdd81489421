from enum import Enum
class Op(Enum):
    ADD = 'add'; SUBTRACT = 'subtract'; MULTIPLY = 'multiply'; DIVIDE = 'divide'
    def __call__(self, a, b):
        if self is Op.ADD: return a + b
        if self is Op.SUBTRACT: return a - b
        if self is Op.MULTIPLY: return a * b
        q, r = divmod(abs(a), abs(b))
        return q if (a < 0) == (b < 0) else -q
