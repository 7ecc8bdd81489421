"""Small helps for the actions."""

from launch._unsupported import lazily_refusing

from .evaluate_parameters import evaluate_parameter_dict
from .names import validate_namespace, validate_node_name
from .namespace_utils import is_namespace_absolute, is_root_namespace, make_namespace_absolute, prefix_namespace
from .normalize_parameters import normalize_parameter_dict, normalize_parameters

__all__ = [
    "evaluate_parameter_dict",
    "is_namespace_absolute",
    "is_root_namespace",
    "make_namespace_absolute",
    "normalize_parameter_dict",
    "normalize_parameters",
    "prefix_namespace",
    "validate_namespace",
    "validate_node_name",
]

__getattr__ = lazily_refusing(
    __name__, frozenset({"evaluate_parameters", "normalize_remap_rules", "to_parameters_list"})
)
