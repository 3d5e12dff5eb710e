"""Attacks on the project with random input: ``make fuzz``, and the replay of what they have found.

An attack is a module with a ``NAME``, a function ``round`` that draws one round of input and says
what it tried and what failed, and a function ``replay`` that tries one saved failure again.
"""

from . import arguments, kernels, postures, single, tables, targets

ATTACKS = {a.NAME: a for a in (postures, targets, single, arguments, kernels, tables)}
