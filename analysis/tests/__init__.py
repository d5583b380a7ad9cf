"""Tests of the analysis, on tiny made-up tables.

python -m unittest discover --top-level-directory analysis --start-directory analysis/tests
"""
