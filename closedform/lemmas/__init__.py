"""The lemmas that solve for a joint, one file a family, and the chain that links them.

A lemma is a function that adds its statements to a :class:`~closedform.model.functions.Program` and
returns a :class:`~closedform.model.lemma.Lemma`: the equations, the unknowns and the closed form of
each.  The closed forms are chosen for the boundary of the workspace: differences of lengths, or of
their squares, under the roots instead of ``1 - cos(x)**2``, and ``atan2`` instead of ``acos``.

:func:`closedform.proof.links.prove_lemma` proves a lemma once, for symbolic coefficients: its
solutions satisfy the equations, and the equations have no others.
"""
