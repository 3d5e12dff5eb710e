"""The names and texts that a derivation may use.

Names become identifiers of Python, C and JavaScript and names of files.  A name that already means
something there is refused when it is declared.  A text may contain any printable characters,
because :mod:`closedform.emit.escape` escapes it for each language; only control characters are
refused.
"""

from __future__ import annotations

import keyword
import re
from collections.abc import Collection, Sequence

C_WORDS = frozenset({
    "alignas", "alignof", "asm", "auto", "bool", "break", "case", "catch", "char", "class",
    "const", "constexpr", "continue", "decltype", "default", "delete", "do", "double", "else",
    "enum", "explicit", "export", "extern", "false", "float", "for", "friend", "goto", "if",
    "inline", "int", "long", "mutable", "namespace", "new", "noexcept", "nullptr", "operator",
    "private", "protected", "public", "register", "restrict", "return", "short", "signed",
    "sizeof", "static", "struct", "switch", "template", "this", "throw", "true", "try",
    "typedef", "typeid", "typename", "typeof", "union", "unsigned", "using", "virtual", "void",
    "volatile", "while",
    "FILE", "double_t", "float_t", "real_t",
    "BIG_ENDIAN", "BUFSIZ", "BYTE_ORDER", "DECIMAL_DIG", "EDOM", "EILSEQ", "EOF", "ERANGE",
    "FILENAME_MAX", "FOPEN_MAX", "HUGE_VALF", "HUGE_VALL", "HUGE_VAL", "I", "INFINITY",
    "LITTLE_ENDIAN", "MATH_ERREXCEPT", "MATH_ERRNO", "MAXFLOAT", "MB_LEN_MAX", "NAN", "NULL",
    "PDP_ENDIAN", "SNAN", "SNANF", "SNANL", "TMP_MAX", "assert", "complex", "errno", "far",
    "i386", "imaginary", "linux", "math_errhandling", "near", "stderr", "stdin", "stdout", "unix",
})  # fmt: skip
"""Keywords of C and C++ (the headers may be included there); types and macros of headers."""
C_FAMILIES = re.compile(
    r"u?int\w*_t|(size|ptrdiff|wchar|fpos|div|max_align)_t"
    r"|(S|U)?(CHAR|SHRT|INT|LONG|LLONG|LONG_LONG)_(BIT|MIN|MAX|WIDTH)"
    r"|U?INT\w*_(MIN|MAX|WIDTH|C)|(PTRDIFF|S?SIZE|SIG_ATOMIC|WCHAR|WINT)_(MIN|MAX|WIDTH)"
    r"|(FLT|L?DBL)_[A-Z0-9_]+|FP_[A-Z0-9_]+|SEEK_[A-Z]+|L_(ctermid|cuserid|tmpnam)|P_tmpdir"
    r"|M_(E|LOG2E|LOG10E|LN2|LN10|[12]_PI|PI(_[24])?|2_SQRTPI|SQRT2|SQRT1_2)(l|f(\d+x?)?)?"
    r"|(HUGE_VAL_|SNAN)F\d+X?|BOOL_(MAX|WIDTH)|L?ULL?ONG_(MAX|WIDTH)|RENAME_[A-Z]+"
)
"""Families of types and macros of the headers of C."""
RESERVED_PREFIXES = ("cf_", "CF_", "closedform_", "CLOSEDFORM_")
"""Prefixes of the names in the shared C header."""
C_LOCALS = frozenset({
    "params", "local", "lanes", "sines", "cosines", "n", "i", "length", "start",
    "single", "opposite", "adjacent", "angles", "principals", "turned", "wide", "rare", "signs",
    "k", "exponent", "excess", "dimensions", "params_scaled", "one",
    "steady", "steady_sines", "steady_cosines",
})  # fmt: skip
"""Names of local variables in the generated C functions."""
C_SUFFIXES = ("_i", "_stride", "_real", "_lanes")
"""Suffixes that the C functions append to the names of arrays."""
PYTHON_LOCALS = frozenset({
    "np", "params", "out", "Any", "ArrayLike", "NamedTuple", "Parameters", "Positions",
    "Solutions", "Status", "ASSEMBLY_MODES", "BRANCHES", "JOINTS", "LIMITS", "SINGULARITIES",
    "SKELETON", "Skeleton", "SkeletonJoint", "TASK",
})  # fmt: skip
"""Names that the NumPy modules define or import themselves."""
JAVASCRIPT_WORDS = frozenset({
    "arguments", "await", "break", "case", "catch", "class", "const", "continue", "debugger",
    "default", "delete", "do", "else", "enum", "eval", "export", "extends", "false", "finally",
    "for", "function", "if", "implements", "import", "in", "instanceof", "interface", "let", "new",
    "null", "package", "private", "protected", "public", "return", "static", "super", "switch",
    "this", "throw", "true", "try", "typeof", "undefined", "var", "void", "while", "with", "yield",
    "Infinity", "Math", "NaN", "Number", "Object",
})  # fmt: skip
"""Words of JavaScript, and the global objects that its modules use."""
JAVASCRIPT_LOCALS = frozenset({"parameters"})
"""Names that the functions of the JavaScript modules use themselves."""
RESERVED_FUNCTIONS = frozenset({"default", "fields", "params", "runtime", "values"})
"""Names that the printed code uses itself, after the name of the robot or an underscore."""
FUNCTION_SUFFIXES = frozenset({
    "batch", "branch", "branches", "common", "in", "kernel", "lanes", "many", "one", "out", "whole",
})  # fmt: skip
"""Suffixes that the printed code appends to the name of a function."""
NOT_FINITE = frozenset({"nan", "inf", "infinity", "oo", "zoo"})
RESERVED_FILES = frozenset({"closedform", "extension", "index"})
"""Other files in the folders of generated code."""
HEADERS = frozenset({
    "aio", "alloca", "assert", "complex", "conio", "cpio", "ctype", "dirent", "dlfcn", "endian",
    "errno", "features", "fcntl", "fenv", "float", "fmtmsg", "fnmatch", "ftw", "getopt", "glob",
    "grp", "iconv", "inttypes", "io", "iso646", "langinfo", "libgen", "limits", "locale",
    "malloc", "math", "memory", "monetary", "mqueue", "ndbm", "net", "netdb", "nl_types", "poll",
    "process", "pthread", "pwd", "python", "regex", "resource", "sched", "search", "semaphore",
    "setjmp", "signal", "spawn", "stdalign", "stdarg", "stdatomic", "stdbit", "stdbool",
    "stdckdint", "stddef", "stdint", "stdio", "stdlib", "stdnoreturn", "string", "strings",
    "stropts", "syslog", "tar", "termios", "tgmath", "threads", "time", "trace", "uchar",
    "ulimit", "unistd", "utime", "utmpx", "values", "wchar", "wctype", "windows", "wordexp",
})  # fmt: skip
"""Headers of C, POSIX and Windows: a generated header with the same name would hide them."""
DEVICES = re.compile(r"aux|con|nul|prn|(com|lpt)\d")
"""Names that a file cannot have on Windows."""
MAX_LENGTH = 63
"""C guarantees that this many characters of a name are significant."""


def in_c(name: str) -> bool:
    """Whether a name already has a meaning in C."""
    return name in C_WORDS or C_FAMILIES.fullmatch(name) is not None


def in_python(name: str) -> bool:
    """Whether a name already has a meaning in a NumPy module."""
    return keyword.iskeyword(name) or name in PYTHON_LOCALS


def in_javascript(name: str) -> bool:
    """Whether a name has a meaning of its own in a JavaScript module."""
    return name in JAVASCRIPT_WORDS


MEANINGS = {"Python": in_python, "C": in_c, "JavaScript": in_javascript}
"""For each language, a test whether a name already has a meaning in it."""


def check_identifier(name: str, where: str) -> None:
    """Raise ``ValueError`` unless a name consists of ASCII letters, digits and ``_``."""
    if not re.fullmatch("[A-Za-z][A-Za-z0-9_]*", name):
        raise ValueError(
            f"{where}: {name!r} is not a name: use letters, digits and _, with a letter first"
        )
    if len(name) > MAX_LENGTH:
        raise ValueError(f"{where}: {name} is longer than {MAX_LENGTH} characters")
    if name.startswith(RESERVED_PREFIXES):
        raise ValueError(f"{where}: names like {name} belong to closedform.h; choose another one")


def check_symbol(name: str, where: str) -> None:
    """Raise ``ValueError`` unless a parameter or a joint may have this name."""
    check_identifier(name, where)
    if name.lower() in NOT_FINITE:
        raise ValueError(f"{where}: {name} is not a finite number, and not a name either")
    languages = [language for language, has_meaning in MEANINGS.items() if has_meaning(name)]
    if languages:
        raise ValueError(
            f"{where}: {name} is a word of {' and '.join(languages)}; choose another name, such "
            f"as {name}_0"
        )


def check_argument(name: str, others: Collection[str], where: str) -> None:
    """Raise ``ValueError`` unless an input or an output may have this name next to the others."""
    check_symbol(name, where)
    base = next((name.removesuffix(s) for s in C_SUFFIXES if name.endswith(s)), "")
    taken = C_LOCALS | JAVASCRIPT_LOCALS | frozenset(others)
    if name in taken or base in taken or re.fullmatch(r"(angle|wide)_\d+", name):
        raise ValueError(f"{where}: the name {name} is taken; choose another one, such as {name}_0")


def check_function(name: str, others: Collection[str], where: str) -> None:
    """Raise ``ValueError`` unless a function may have this name next to the others."""
    check_identifier(name, where)
    if name != name.lower():
        raise ValueError(f"{where}: write the function {name} in lower-case letters")
    if in_python(name) or in_javascript(name) or name in RESERVED_FUNCTIONS:
        raise ValueError(f"{where}: the name {name} is taken; call the function {name}_0, say")
    for other in others:
        short, long = sorted((name, other), key=len)
        suffixes = long[len(short) + 1 :].split("_")
        if long.startswith(f"{short}_") and FUNCTION_SUFFIXES.issuperset(suffixes):
            raise ValueError(
                f"{where}: the printed code of {short} uses the name {long} itself; call the "
                f"function {name}_0, say"
            )


def check_own(name: str, robot: str, functions: Collection[str], where: str) -> None:
    """Raise ``ValueError`` if the C code of the robot declares this name."""
    parts = ("params", *functions)
    if name == f"{robot.upper()}_DEFAULTS" or (
        name.startswith(f"{robot}_") and name[len(robot) + 1 :].startswith(parts)
    ):
        raise ValueError(f"{where}: the C code of {robot} uses the name {name} itself")


def check_label(label: str, where: str) -> None:
    """Raise ``ValueError`` unless a branch, a mode or a task coordinate may have this name."""
    if not re.fullmatch("[A-Za-z0-9][A-Za-z0-9_]*", label):
        raise ValueError(
            f"{where}: {label!r} is not a name: use letters, digits and _, not with a _ first"
        )


def check_labels(labels: Collection[str], where: str) -> None:
    """Raise ``ValueError`` unless these are distinct names."""
    if isinstance(labels, str):
        raise TypeError(f"{where}: give a sequence of names, not the string {labels!r}")
    for label in labels:
        check_label(label, where)
    if repeated := sorted({x for x in labels if list(labels).count(x) > 1}):
        raise ValueError(f"{where}: the name {repeated[0]} is given twice")


def check_key(key: str, where: str) -> None:
    """Raise ``ValueError`` unless a paper may have this key."""
    if not re.fullmatch(r"[A-Za-z0-9_.-]*", key):
        raise ValueError(f"{where}: {key!r} is not a key: use letters, digits, _, . and -")


def check_text(where: str, *texts: str, lines: bool = False) -> None:
    """Raise ``ValueError`` unless the texts are printable, each on one line unless ``lines``.

    Control characters are refused, including those that change the direction of writing.
    """
    for text in texts:
        if not isinstance(text, str):
            raise TypeError(f"{where}: {text!r} must be a string")
        for character in text:
            if not character.isprintable() and not (lines and character == "\n"):
                raise ValueError(
                    f"{where}: {text!r} must be one line of printable text, without the "
                    f"character U+{ord(character):04X}"
                    if not lines
                    else f"{where}: {text!r} must be printable, without the character "
                    f"U+{ord(character):04X}"
                )


def check_formulas(where: str, *texts: str) -> None:
    """Raise ``ValueError`` unless each dollar sign that begins a formula has one that ends it."""
    for text in texts:
        if text.count("$") % 2:
            raise ValueError(f"{where}: a dollar sign is not closed: {text}")


def check_robot(name: str) -> None:
    """Raise ``ValueError`` unless a robot, its module and its C files may have this name."""
    if not re.fullmatch("[A-Za-z][A-Za-z0-9_]*", name) or len(name) > MAX_LENGTH:
        raise ValueError(
            f"{name!r} is not a name of a module: use letters, digits and _, with a letter first, "
            f"{MAX_LENGTH} characters at most"
        )
    if name.lower() in HEADERS or DEVICES.fullmatch(name.lower()):
        raise ValueError(
            f"{name}.h is a header of the system; choose another name, such as {name}_0"
        )
    if (
        keyword.iskeyword(name)
        or name.lower() in RESERVED_FILES
        or name.startswith(RESERVED_PREFIXES)
    ):
        raise ValueError(f"the name {name} is taken; choose another, such as {name}_0")


def listed(texts: Sequence[str]) -> str:
    """Texts in a sentence: ``a, b and c``."""
    return " and ".join(filter(None, [", ".join(texts[:-1]), *texts[-1:]]))


__all__ = [
    "check_argument",
    "check_function",
    "check_identifier",
    "check_key",
    "check_label",
    "check_labels",
    "check_own",
    "check_robot",
    "check_symbol",
    "check_text",
    "in_c",
    "in_javascript",
    "in_python",
    "listed",
]
