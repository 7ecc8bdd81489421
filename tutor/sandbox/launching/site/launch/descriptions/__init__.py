"""What a process is made of."""

from .executable import Executable

__all__ = ["Executable"]
