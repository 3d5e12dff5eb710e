"""Which lemmas solve an arm: one file for each structure, and the choice between them."""
