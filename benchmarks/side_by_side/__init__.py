"""The same tasks with closedform and with its peers, on the same arm and the same targets."""
