"""The papers behind the derivations, one file each."""
