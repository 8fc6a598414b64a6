"""Small errors in a text of C, JavaScript or Python: the usual operators, applied to the syntax tree."""

import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import tree_sitter_c
import tree_sitter_javascript
import tree_sitter_python
from tree_sitter import Language, Node, Parser

GRAMMARS = {".c": tree_sitter_c, ".h": tree_sitter_c, ".js": tree_sitter_javascript, ".py": tree_sitter_python}

ARITHMETIC = {"+": "-", "-": "+", "*": "/", "/": "*", "%": "*", "//": "*", "**": "*"}
ARITHMETIC |= {f"{sign}=": f"{other}=" for sign, other in ARITHMETIC.items()}
COMPARISON = {"<": ("<=", ">"), "<=": ("<", ">="), ">": (">=", "<"), ">=": (">", "<="), "==": ("!=",), "!=": ("==",)}
COMPARISON |= {"===": ("!==",), "!==": ("===",), "in": ("not in",), "not in": ("in",)}
COMPARISON |= {"is": ("is not",), "is not": ("is",)}
BOOLEAN = {"and": "or", "or": "and", "&&": "||", "||": "&&"}
TRUTH = {"True": "False", "False": "True", "true": "false", "false": "true"}

OPERATIONS = {"binary_expression", "binary_operator", "boolean_operator", "comparison_operator"}
ASSIGNMENTS = {"assignment_expression", "augmented_assignment", "augmented_assignment_expression"}
NUMBERS = {"float", "integer", "number", "number_literal"}
FUNCTIONS = {
    "class_declaration",
    "class_definition",
    "function_declaration",
    "function_definition",
    "method_definition",
}
SILENT = {"ERROR", "comment", "decorator", "string", "string_literal", "template_string", "type"}
"""What is left as it is: words, types and what the grammar cannot read."""
NOTHING = {".c": "{}", ".h": "{}", ".js": "{}", ".py": "pass"}
NO_VALUE = {".c": "return 0;", ".h": "return 0;", ".js": "return undefined;", ".py": "return None"}
NOT_AN_ARGUMENT = {"comment", "dictionary_splat", "keyword_argument", "list_splat", "spread_element"}
FACTORS = (2.0, 1.1, 1.01)


@dataclass(frozen=True)
class Change:
    """One small error."""

    operator: str
    """Its kind."""
    start: int
    end: int
    """`start`, `end`: bytes of the text that are replaced."""
    new: str
    """What replaces them."""
    function: str
    """Classes and functions around it, with points between; empty outside of all."""


def alike(suffix: str) -> set[str]:
    """Suffixes of the same language."""
    return {other for other, grammar in GRAMMARS.items() if grammar is GRAMMARS[suffix]}


@cache
def _parser(suffix: str) -> Parser:
    return Parser(Language(GRAMMARS[suffix].language()))


def unread(source: bytes, suffix: str) -> int:
    """Number of places that the grammar cannot read."""
    return sum(node.type == "ERROR" or node.is_missing for node in _nodes(_parser(suffix).parse(source).root_node))


def function_at(source: bytes, suffix: str, place: int) -> str:
    """Classes and functions around a byte, with points between."""
    return _function(_parser(suffix).parse(source).root_node.descendant_for_byte_range(place, place))


def changes(source: bytes, suffix: str) -> Iterator[Change]:
    """All small errors of a text, in its order."""
    for node in _nodes(_parser(suffix).parse(source).root_node, SILENT):
        for operator, first, last, new in _of_node(node, suffix):
            yield Change(operator, first.start_byte, last.end_byte, new, _function(node))


def _nodes(node: Node, silent: Collection[str] = ()) -> Iterator[Node]:
    stack = [node]
    while stack:
        node = stack.pop()
        if node.type not in silent:
            yield node
            stack.extend(reversed(node.children))


def _function(node: Node | None) -> str:
    names: list[str] = []
    while node is not None:
        named = node if node.type in FUNCTIONS else None
        if node.type == "variable_declarator" and node.children[-1].type in ("arrow_function", "function_expression"):
            named = node
        if named is not None:
            name = named.child_by_field_name("name") or named.child_by_field_name("declarator")
            while name is not None and (inner := name.child_by_field_name("declarator")) is not None:
                name = inner  # C: the name is inside of the parameters and the pointers
            names.insert(0, _text(name))
        node = node.parent
    return ".".join(names)


def _text(node: Node | None) -> str:
    return "" if node is None or node.text is None else node.text.decode()


Found = tuple[str, Node, Node, str]


def _of_node(node: Node, suffix: str) -> Iterator[Found]:
    for rule in (_signs, _numbers, _statements, _order):
        yield from rule(node, suffix)


def _signs(node: Node, suffix: str) -> Iterator[Found]:
    """Operators of two values and of one, and truth."""
    kind, around = node.type, node.parent
    if node.is_named or around is None:
        strict = around is not None and _text(around) == "strict=True"  # of zip(), a guard that changes no result
        if kind in ("true", "false") and not strict:
            yield "truth", node, node, TRUTH[_text(node)]
        return
    if around.type in OPERATIONS | ASSIGNMENTS:
        if kind in ARITHMETIC:
            yield "arithmetic", node, node, ARITHMETIC[kind]
        if kind in BOOLEAN:
            yield "boolean", node, node, BOOLEAN[kind]
        for other in COMPARISON.get(kind, ()):
            yield "comparison", node, node, other
    elif (kind == "-" and around.type in ("unary_expression", "unary_operator")) or (
        kind in ("not", "!") and around.type in ("unary_expression", "not_operator")
    ):
        yield ("sign" if kind == "-" else "not"), node, node, ""


def _numbers(node: Node, suffix: str) -> Iterator[Found]:
    """Whole numbers by one, others by a factor that their place chooses."""
    text = _text(node) if node.type in NUMBERS else ""
    if re.fullmatch(r"\d+", text):
        yield "constant", node, node, str(int(text) + 1)
        if text == "1":
            yield "constant", node, node, "0"
    elif re.fullmatch(r"(\d+\.\d*|\.\d+|\d+(?=[eE]))([eE][-+]?\d+)?", text):
        value = float(text)
        yield "constant", node, node, repr(value * FACTORS[node.start_byte % len(FACTORS)] if value else 1.0)


def _statements(node: Node, suffix: str) -> Iterator[Found]:
    """Calls and assignments that are taken away, and values that are not returned."""
    if node.type == "expression_statement":
        inner = node.named_children[0] if node.named_children else None
        left = inner.child_by_field_name("left") if inner is not None else None
        if inner is not None and inner.type in ("await", "await_expression"):
            inner = inner.named_children[0]
        if inner is not None and (
            inner.type in {"call", "call_expression"} | ASSIGNMENTS
            or (inner.type == "assignment" and left is not None and left.type in ("attribute", "subscript"))
        ):
            yield "removed statement", node, node, NOTHING[suffix]
    elif node.type == "return_statement":
        value = node.named_children[0] if node.named_children else None
        if value is not None and not re.fullmatch(r"0|None|undefined|false|\w+_OK", _text(value)):
            yield "returned value", node, node, NO_VALUE[suffix]


def _order(node: Node, suffix: str) -> Iterator[Found]:
    """Neighbouring arguments and indices that change their places."""
    pairs: list[tuple[Node, Node]] = []
    if node.type in ("argument_list", "arguments") and node.parent is not None and node.parent.type not in FUNCTIONS:
        pairs = [pair for pair in pairwise(node.named_children) if not {n.type for n in pair} & NOT_AN_ARGUMENT]
    elif node.type == "subscript":
        pairs = list(pairwise(node.children_by_field_name("subscript")))
    elif node.type == "subscript_expression":
        inner = node.child_by_field_name("argument") or node.child_by_field_name("object")
        indices = inner and inner.child_by_field_name("index"), node.child_by_field_name("index")
        if inner is not None and inner.type == node.type and None not in indices:
            pairs = [indices]
    for first, second in pairs:
        one_line = first.start_point.row == second.end_point.row
        if one_line and _text(first) != _text(second):
            between = (node.text or b"")[
                first.end_byte - node.start_byte : second.start_byte - node.start_byte
            ].decode()
            yield "order", first, second, f"{_text(second)}{between}{_text(first)}"
