"""The substitutions that know packages."""

from launch._unsupported import lazily_refusing

from .executable_in_package import ExecutableInPackage
from .find_package import FindPackage, FindPackagePrefix, FindPackageShare

__all__ = ["ExecutableInPackage", "FindPackage", "FindPackagePrefix", "FindPackageShare"]

__getattr__ = lazily_refusing(__name__, frozenset({"Parameter"}))
