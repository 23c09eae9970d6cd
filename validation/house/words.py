"""Words of the source: names that are no nouns, words of docstrings, types left open."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator, Sequence

from validation.house.source import Source, documented

#: pronouns, prepositions, adverbs and participles that stand where a noun belongs
PRONOUNS = frozenset(
    "one ones found own at told known other others left here what held kept there these those it"
    " its his their theirs them this that such same apart alike seen said asked made given taken"
    " put set_out done ever now then beyond beside over under within without into up down on"
    " off by of to from with for per again rest all both each either every any some none whole"
    " mine ours who whose where when why how let got gone come shown named written counted".split()
)
#: words of docstrings that other projects of the field use otherwise, by ten thousand words
DIALECT = (
    "of its one what where those told tell tells beside apart alike compute computes calculate"
    " return returns matrix vector"
).split()


def bindings(source: Source) -> Iterator[str]:
    """Yield the names that a file gives: variables, parameters, functions and classes."""
    for node in ast.walk(source.tree):
        match node:
            case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name):
                yield name.lstrip("_")
            case ast.ClassDef(name=name):
                yield name.lstrip("_").lower()
            case ast.arg(arg=name) if name not in ("self", "cls"):
                yield name.lstrip("_")
            case ast.Name(id=name, ctx=ast.Store()):
                yield name.lstrip("_")


def pronouns(files: Sequence[Source]) -> tuple[Counter[str], int]:
    """Return how often each name that is no noun is given, and how many names are given."""
    names = Counter(name for source in files for name in bindings(source))
    return Counter({n: k for n, k in names.items() if n in PRONOUNS}), sum(names.values())


def docstring_words(files: Sequence[Source]) -> tuple[Counter[str], int]:
    """Return how often each word stands in docstrings, and how many words there are."""
    words: Counter[str] = Counter()
    for source in files:
        for docstring in documented(source.tree):
            words.update(re.findall(r"[a-z']+", str(docstring.value).lower()))
    return words, sum(words.values())


def open_types(files: Sequence[Source]) -> Counter[str]:
    """Return parameters and fields of type `Any`, by room."""
    count: Counter[str] = Counter()
    for source in files:
        for node in ast.walk(source.tree):
            annotation = getattr(node, "annotation", None)
            if annotation is not None and re.search(r"\bAny\b", ast.unparse(annotation)):
                count[source.room] += 1
    return count


def shapes(files: Sequence[Source]) -> Counter[str]:
    """Return how often the source uses forms that a reader has to parse twice."""
    count: Counter[str] = Counter()
    for source in files:
        for node in ast.walk(source.tree):
            count.update(_shapes(node))
    return count


def _shapes(node: ast.AST) -> Iterator[str]:
    match node:
        case ast.BinOp(op=ast.Mult(), left=left, right=right):
            for text, factor in ((left, right), (right, left)):
                if _is_text(text) and _is_truth(factor):
                    yield "text times a truth value"
        case ast.AugAssign(op=ast.Mult(), value=ast.Compare() | ast.BoolOp()):
            yield "text times a truth value"
        case ast.Call(args=arguments):
            yield from (
                "starred name in a call"
                for a in arguments
                if isinstance(a, ast.Starred) and isinstance(a.value, ast.Name)
            )
        case ast.If(test=test) | ast.While(test=test) | ast.IfExp(test=test):
            if any(isinstance(inner, ast.IfExp) for inner in ast.walk(test)):
                yield "conditional inside a condition"


def _is_truth(node: ast.AST) -> bool:
    match node:
        case ast.Compare() | ast.BoolOp() | ast.UnaryOp(op=ast.Not()):
            return True
        case ast.Call(func=ast.Name(id="bool")):
            return True
    return False


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.JoinedStr) or (
        isinstance(node, ast.Constant) and isinstance(node.value, str)
    )
