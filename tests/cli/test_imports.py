"""What a script imports is found wherever the statement stands."""

from pathlib import Path

import pytest

from closedform.pipeline.imports import sources_of

BLOCKS = {
    "plain": "import other",
    "function": "def f():\n    import other",
    "method": "class C:\n    async def f(self):\n        from other import x",
    "if": "if True:\n    import other",
    "else": "if True:\n    pass\nelse:\n    import other",
    "loop": "for _ in ():\n    while True:\n        import other",
    "else of a loop": "for _ in ():\n    pass\nelse:\n    import other",
    "with": "with open('x'):\n    import other",
    "try": "try:\n    import other\nfinally:\n    pass",
    "except": "try:\n    pass\nexcept OSError:\n    import other",
    "finally": "try:\n    pass\nfinally:\n    import other",
    "match": "match 1:\n    case 1:\n        import other",
    "behind a lambda": "f = lambda: 1 if True else 2\nimport other",
}


@pytest.mark.parametrize("block", BLOCKS)
def test_an_import_is_found_in(block: str, tmp_path: Path) -> None:
    script, other = tmp_path / "script.py", tmp_path / "other.py"
    other.write_text("x = 1\n")
    script.write_text(BLOCKS[block] + "\n")
    assert sources_of([script]) == [other, script]
