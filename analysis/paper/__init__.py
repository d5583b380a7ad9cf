"""The paper's evaluation: what is run, what is read from the results, and how it compares with the paper."""
