"""What a module says, read by the tests of its words and of what it imports."""

import ast
import gc
from contextlib import contextmanager


@contextmanager
def no_garbage():
    """Look for no garbage meanwhile: a tree holds none, and looking doubles what it takes."""
    gc.disable()
    try:
        yield
    finally:
        gc.enable()


def statements(tree: ast.AST):
    """Yield a tree and every statement in it, those within others included, but no expression.

    They are a tenth of what `ast.walk` yields.
    """
    waiting = [tree]
    while waiting:
        node = waiting.pop()
        yield node
        for part in ("body", "orelse", "finalbody", "handlers", "cases"):
            within = getattr(node, part, ())
            if isinstance(within, list):
                waiting.extend(within)


def everything(tree: ast.AST):
    """Yield all of a tree but whether names are read or set, in half the time of `ast.walk`."""
    waiting = [tree]
    while waiting:
        node = waiting.pop()
        yield node
        for part, value in node.__dict__.items():
            if isinstance(value, list):
                waiting.extend([one for one in value if isinstance(one, ast.AST)])
            elif part != "ctx" and isinstance(value, ast.AST):
                waiting.append(value)
