"""The files that describe a closed loop: what is recognised in them, and the script of each."""
