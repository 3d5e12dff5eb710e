"""Closed loops: from the legs or the bodies of a mechanism to its functions and its skeleton.

A function that an author calls is in the file of its name: ``parallel.py``, ``platform.py``,
``tripod.py``, ``guided.py``, ``coupled.py``, ``slotted.py``, ``on_rod.py``; ``linkage`` is in
``dyads.py``.  The legs, and the lemmas that solve for them, are in :mod:`closedform.lemmas`.
"""
