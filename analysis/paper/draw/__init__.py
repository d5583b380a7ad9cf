"""The figures, each from `figures.json` and the paper's numbers alone."""
