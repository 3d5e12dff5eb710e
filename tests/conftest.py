"""What all tests share: repeatable examples, and the table of the worst errors found."""

import pytest
from hypothesis import settings

from closedform.crosscheck import Finding, table

# The same examples on every run: a failure can be repeated, and a build is stable.
settings.register_profile("repeatable", deadline=None, derandomize=True)
settings.load_profile("repeatable")

FINDINGS = pytest.StashKey[list[Finding]]()


@pytest.fixture(scope="session")
def findings(pytestconfig: pytest.Config) -> list[Finding]:
    """Collects what the cross-checks find, for the table at the end."""
    return pytestconfig.stash.setdefault(FINDINGS, [])


def pytest_terminal_summary(
    terminalreporter: pytest.TerminalReporter, config: pytest.Config
) -> None:
    found = config.stash.get(FINDINGS, [])
    if found:
        terminalreporter.section("worst error of each generated function")
        for line in table(found):
            terminalreporter.write_line(line)
