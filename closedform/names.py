"""Which names symbols and robots may have: they become identifiers of Python, NumPy code and C."""

from __future__ import annotations

import keyword

C_WORDS = frozenset({
    "alignas", "alignof", "asm", "auto", "bool", "break", "case", "catch", "char", "class",
    "const", "constexpr", "continue", "decltype", "default", "delete", "do", "double", "else",
    "enum", "explicit", "export", "extern", "false", "float", "for", "friend", "goto", "if",
    "inline", "int", "long", "mutable", "namespace", "new", "noexcept", "nullptr", "operator",
    "private", "protected", "public", "register", "restrict", "return", "short", "signed",
    "sizeof", "static", "struct", "switch", "template", "this", "throw", "true", "try",
    "typedef", "typeid", "typename", "typeof", "union", "unsigned", "using", "virtual", "void",
    "volatile", "while", "HUGE_VAL", "INFINITY", "NAN", "NULL", "real_t", "size_t", "uint8_t",
})  # fmt: skip
"""Words of C and, for those who include the headers there, of C++; types and macros of headers."""
PRINTED = frozenset({"np"})
"""What the NumPy modules call their own."""
NOT_FINITE = frozenset({"nan", "inf", "infinity", "oo", "zoo"})
FILES = frozenset({"closedform", "extension"})
"""Files beside those of the robots, in a folder of generated code."""


def check_symbol(name: str, where: str) -> None:
    """Raise ``ValueError`` unless a parameter or a joint may have this name."""
    if not (name.isascii() and name.isidentifier()) or name.startswith("_"):
        raise ValueError(
            f"{where}: {name!r} is no name: take letters, digits and _, with a letter first"
        )
    if name.lower() in NOT_FINITE:
        raise ValueError(f"{where}: {name} is no finite number, and no name either")
    if keyword.iskeyword(name) or name in C_WORDS | PRINTED:
        raise ValueError(
            f"{where}: {name} is a word of Python or C; take another name, such as {name}_0"
        )


def check_text(where: str, *texts: str) -> None:
    """Raise ``ValueError`` where a text would end the comment or the docstring it is printed in."""
    for text in texts:
        if found := [part for part in ("*/", "/*", '"""', "\\") if part in text]:
            raise ValueError(f"{where}: {text!r} goes into comments: leave out {found[0]}")
        if not text.isprintable():
            raise ValueError(f"{where}: {text!r} must be one line of text")


def check_robot(name: str) -> None:
    """Raise ``ValueError`` unless a robot, with its module and its C files, may have this name."""
    if not (name.isascii() and name.isidentifier()) or name.startswith("_"):
        raise ValueError(
            f"{name!r} is no name of a module: take letters, digits and _, with a letter first"
        )
    if keyword.iskeyword(name) or name in FILES:
        raise ValueError(f"the name {name} is taken; choose another, such as {name}_0")


__all__ = ["C_WORDS", "check_robot", "check_symbol", "check_text"]
