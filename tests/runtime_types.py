"""The run-time type checker of the tests: types and shapes of the calls of the library are checked.

An int may stand for a float, as PEP 484 says. jaxtyping compares the shapes of the arrays of a call, for which it binds
the arguments and checks them twice; functions without arrays, which are called most often, are checked by beartype
alone, in a tenth of the time.
"""

import ast
import dataclasses
import sys
import types
from collections.abc import Callable, Iterator, Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from pathlib import Path
from typing import Any, Final, get_args, get_type_hints

from beartype import BeartypeConf, beartype
from jaxtyping import AbstractArray, TypeCheckError, jaxtyped

check = beartype(conf=BeartypeConf(is_pep484_tower=True, violation_type=TypeCheckError))

UNCHECKED: Final = frozenset(
    f"shapewright.modeling.{name}" for name in ("control_mesh", "elements", "fields", "program", "subdivision")
)
"""They read, write or collect single numbers: to check millions of such calls takes minutes and finds nothing that the
static types, and the checks of those who use them, do not tell."""


def check_library(package: Path) -> None:
    """Have all modules of the package checked that are imported from now on."""
    sys.meta_path.insert(0, CheckedFinder(frozenset(_modules(package)) - UNCHECKED))


def checked(one: Any) -> Any:
    """Return a function, or a class with its initializer, that checks its arguments and what it returns."""
    if not isinstance(one, type):
        return _checked_function(one)
    made = vars(one).get("__init__")
    if dataclasses.is_dataclass(one) and isinstance(made, types.FunctionType) and not hasattr(made, "__wrapped__"):
        one.__init__ = _checked_function(made)  # type: ignore[misc]
    return one


def _checked_function(function: Callable[..., Any]) -> Callable[..., Any]:
    hints = {name: _resolved(hint, function) for name, hint in function.__annotations__.items()}
    if any(_has_arrays(hint) for hint in hints.values()):
        return jaxtyped(function, typechecker=check)
    function.__annotations__ = hints
    return check(function)


def _resolved(hint: Any, function: Callable[..., Any]) -> Any:
    """Return what a hint in quotes means; anything where it names what is there for the static types alone."""
    holder = types.SimpleNamespace(__annotations__={"value": hint})
    try:
        return get_type_hints(holder, function.__globals__, include_extras=True)["value"]
    except Exception:
        return Any


def _has_arrays(hint: Any) -> bool:
    if isinstance(hint, type) and issubclass(hint, AbstractArray):
        return True
    parts = hint if isinstance(hint, list) else get_args(hint)
    return any(_has_arrays(part) for part in parts)


class Marking(ast.NodeTransformer):
    """Puts the check on classes, and next to each function of a module or class.

    Functions within functions stay as they are: their checks would be compiled anew with every call.
    """

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.AST:
        if not _is_exempt(node):
            node.decorator_list.append(_mark(node))
        return node

    def visit_ClassDef(self, node: ast.ClassDef) -> ast.AST:
        if _is_exempt(node):
            return node
        node.decorator_list.insert(0, _mark(node))
        return self.generic_visit(node)


def _is_exempt(node: ast.FunctionDef | ast.ClassDef) -> bool:
    return any(isinstance(one, ast.Name) and one.id == "no_type_check" for one in node.decorator_list)


def _mark(node: ast.AST) -> ast.expr:
    mark = ast.parse(f"__import__({__name__!r}).checked", mode="eval").body
    for part in ast.walk(mark):
        ast.copy_location(part, node)
    return mark


class CheckedLoader(SourceFileLoader):
    """Compiles a module with the checks; no file keeps what it made."""

    def get_code(self, fullname: str) -> types.CodeType:
        path = self.get_filename(fullname)
        tree = Marking().visit(ast.parse(self.get_data(path), path))
        return compile(tree, path, "exec", dont_inherit=True)


class CheckedFinder(MetaPathFinder):
    """Finds the modules that are to be checked."""

    def __init__(self, modules: frozenset[str]) -> None:
        self._modules = modules

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: types.ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname not in self._modules:
            return None
        spec = PathFinder.find_spec(fullname, path, target)
        if spec is not None and spec.origin is not None:
            spec.loader = CheckedLoader(fullname, spec.origin)
        return spec


def _modules(package: Path) -> Iterator[str]:
    for file in sorted(package.rglob("*.py")):
        parts = file.relative_to(package.parent).with_suffix("").parts
        if parts[-1] != "__init__":  # which only pass names on
            yield ".".join(parts)
