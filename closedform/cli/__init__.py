"""The command line."""

from closedform.cli.commands import main as main
