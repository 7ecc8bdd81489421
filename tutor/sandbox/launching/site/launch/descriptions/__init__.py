"""What a process is made of."""

from .._unsupported import lazily_refusing
from .executable import Executable

__all__ = ["Executable"]

__getattr__ = lazily_refusing(__name__, frozenset())
