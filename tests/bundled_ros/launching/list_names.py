"""Lists the public names of the real launch packages: `python -m tests.bundled_ros.launching.list_names DIR...`.

Each DIR is the folder of one package. Only import statements, definitions and assignments at the top level of modules
are read; nothing is run. The list has a line for each module, and below it a line NAME ORIGIN for each name: ORIGIN is
MODULE:NAME for an imported name, MODULE: for an imported module, and empty for what the module itself defines.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path


def main(folders: list[str]) -> None:
    """Print the names of the packages in these folders."""
    for folder in map(Path, folders):
        for path in sorted(folder.rglob("*.py")):
            parts = path.relative_to(folder.parent).with_suffix("").parts
            is_package = parts[-1] == "__init__"
            module = ".".join(parts[:-1] if is_package else parts)
            named = dict(_names(ast.parse(path.read_text(encoding="utf-8")).body, module, is_package))
            public = {name: origin for name, origin in named.items() if not name.startswith("_")}
            print(f"{module} {'package' if is_package else 'module'}")
            for name, origin in sorted(public.items()):
                print(f"  {name} {origin}" if origin else f"  {name}")


def _names(body: list[ast.stmt], module: str, is_package: bool) -> Iterator[tuple[str, str]]:
    for node in body:
        match node:
            case ast.ImportFrom(module=source, names=names, level=level):
                origin = _absolute(source or "", level, module, is_package)
                for alias in names:
                    if alias.name == "*":
                        raise ValueError(f"{module}: star imports are not supported")
                    yield alias.asname or alias.name, f"{origin}:{alias.name}"
            case ast.Import(names=names):
                for alias in names:
                    target = alias.name if alias.asname else alias.name.partition(".")[0]
                    yield alias.asname or target, f"{target}:"
            case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name) | ast.ClassDef(name=name):
                yield name, ""
            case ast.Assign(targets=targets):
                for target_node in targets:
                    if isinstance(target_node, ast.Name):
                        yield target_node.id, ""
            case ast.AnnAssign(target=ast.Name(id=name)):
                yield name, ""
            case ast.If(test=ast.Name(id="TYPE_CHECKING")):
                yield from _names(node.orelse, module, is_package)
            case ast.If(body=inner, orelse=orelse):
                yield from _names([*inner, *orelse], module, is_package)
            case ast.Try(body=inner, handlers=handlers):
                for handler in handlers:
                    yield from _names(handler.body, module, is_package)
                yield from _names(inner, module, is_package)


def _absolute(source: str, level: int, module: str, is_package: bool) -> str:
    if level == 0:
        return source
    parts = module.split(".")
    parts = parts[: len(parts) - level + (1 if is_package else 0)]
    return ".".join([*parts, *filter(None, [source])])


if __name__ == "__main__":
    main(sys.argv[1:])
