"""How the figures of mechanisms and papers are drawn, a file for each paper."""
