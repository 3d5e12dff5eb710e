"""The graph of dependencies between the steps of a derivation, the inverses and the claims."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from closedform.emit.backends.latex.article import key
from closedform.emit.backends.latex.claims import derives
from closedform.emit.backends.latex.lemmas import label as lemma_label
from closedform.emit.backends.latex.lemmas import lemmas_of
from closedform.emit.markup import anchor
from closedform.model.claims import HOLDS
from closedform.model.derivation import Derivation
from closedform.proof.prove import Proof

WIDTH = 22
"""Characters in a line of a node."""


def rests_on(derivation: Derivation, proof: Proof) -> str:
    """The graph in the language of Graphviz; classes say what is proved."""
    return "\n".join(["digraph {", *_lines(derivation, proof), "}"])


def _lines(derivation: Derivation, proof: Proof) -> Iterator[str]:
    name, steps = derivation.name, derivation.steps
    for k, step in enumerate(steps, 1):
        state = "proved" if step.vanishes and step.title in proof.steps else "definition"
        yield _node(f"s{k}", step.title, state, f"#{anchor(f'step:{name}:{k}')}", "box")
        for earlier in step.uses:
            yield f"s{steps.index(earlier) + 1} -> s{k}"
        verdicts = Counter(
            "holds" if c.kind in HOLDS else c.kind for c in proof.claims if derives(step, c.label)
        )
        for kind, n in sorted(verdicts.items()):
            node = f"c{k}{kind.replace(' ', '')}"
            text = f"{n} claim{'s' if n > 1 else ''}: {'proved' if kind == 'holds' else kind}"
            yield _node(node, text, kind.replace(" ", "-"), "#claims-of-the-paper", "ellipse")
            yield f"s{k} -> {node}"
    lemmas = {n: f"l{k}" for k, n in enumerate(lemmas_of(derivation))}
    for lemma, node in lemmas.items():
        mark = lemma_label(lemma)
        address = f"../lemmas.html#{anchor(mark)}" if mark else ""
        yield _node(node, f"Lemma: {lemma}", "proved", address, "ellipse")
    for k, inverse in enumerate(derivation.inverses):
        address = f"#{anchor(f'inverse:{name}:{key(inverse.function)}')}"
        proved = any(r.function == inverse.function for r in proof.inverses)
        text = f"Inverse: {inverse.function}"
        yield _node(f"i{k}", text, "proved" if proved else "definition", address, "box")
        for lemma in lemmas_of(derivation, inverse.function):
            yield f"{lemmas[lemma]} -> i{k}"


def _node(node: str, text: str, state: str, address: str, shape: str) -> str:
    lines, line = [], ""
    for word in text.replace("\\", "\\\\").replace('"', "'").split():
        if line and len(line) + len(word) >= WIDTH:
            lines.append(line)
            line = ""
        line = f"{line} {word}".strip()
    label = "\\n".join([*lines, line])
    link = f', URL="{address}"' if address else ""
    return f'{node} [label="{label}", class="{state}", shape={shape}{link}]'
