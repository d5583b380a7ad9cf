#!/usr/bin/env python3
"""Prints the scorecard: every claim of the paper's section 5, what we found, and whether the two agree.

    python analysis/scorecard.py
    python analysis/scorecard.py --list      # what is to be judged, by which rule and margin, and under which readings

Reads results/ where `run_paper.py` has left all runs of a figure with all their trials, and brings
results/paper/figures.json up to date with them. Takes what is missing from that file as committed, which needs nothing
but Python itself. Writes results/paper/scorecard.json.
"""

from __future__ import annotations

import argparse
import json
import sys
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from paper import claims, stated
from paper.evaluation import ROOT, TRIALS
from paper.verdict import AGREES, CANNOT_SAY, DIFFERS

OUT = ROOT / "results" / "paper"
WIDTH = 100


def parser(about: str | None) -> argparse.ArgumentParser:
    """The options that scorecard and figures share."""
    made = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    made.add_argument("--results", type=Path, default=ROOT / "results", help="folder of the results folders")
    made.add_argument("--out", type=Path, default=OUT, help="where figures.json is and what is made goes")
    made.add_argument("--trials", type=int, default=TRIALS, help=f"trials that a run must have to count [{TRIALS}]")
    return made


def figures(results: Path, out: Path, trials: int) -> dict[str, Any]:
    """What the claims are judged by, brought up to date with `results` if there is anything, and if polars is there."""
    out.mkdir(parents=True, exist_ok=True)
    path = out / "figures.json"
    known = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
    if not any(results.glob("*/manifest.json")):
        print(f"No runs in {results}: figures as committed.\n")
        return known
    try:
        from paper import collect
    except ImportError as missing:
        print(f"{missing}: figures as committed (pip install --requirement analysis/requirements.txt).\n")
        return known
    sections, sources = collect.collect(results, known, trials)
    for name, source in sources.items():
        print(f"{name}: {source}")
    print()
    collect.write(path, sections)
    return sections


def shown(value: Any) -> str:
    """A figure as text."""
    if value is None:
        return "–"
    if isinstance(value, str):
        return value
    return f"{value:,.4g}" if abs(value) < 1000 else f"{value:,.0f}"


def entry(claim: dict[str, Any]) -> str:
    """A claim on a few lines."""
    interval = "" if claim["ci95"] is None else f" [{', '.join(shown(end) for end in claim['ci95'])}]"
    trials = "" if claim["trials"] is None else f", {claim['trials']} trials"
    head = f"{claim['verdict']:<10}  {claim['claim']}"
    lines = textwrap.wrap(head, WIDTH, subsequent_indent=" " * 12)
    facts = f"paper {shown(claim['paper'])}; ours {shown(claim['ours'])}{interval}{trials}; {claim['kind']}"
    note = f" ({claim['note']})" if claim["note"] else ""
    return "\n".join([*lines, *textwrap.wrap(facts + note, WIDTH, initial_indent=" " * 12, subsequent_indent=" " * 12)])


def totals(card: list[dict[str, Any]]) -> str:
    """How many of each verdict, calibrated ones apart: they could not but agree."""
    predictions = [claim for claim in card if claim["kind"] == claims.PREDICTION]
    verdicts = [claim["verdict"] for claim in predictions]
    counts = [f"{verdicts.count(name)} {name}" for name in (AGREES, DIFFERS, CANNOT_SAY)]
    fitted = [claim for claim in card if claim["kind"] == claims.CALIBRATED]
    return f"Of {len(predictions)} predictions: {', '.join(counts)}. {len(fitted)} more claims are what was fitted."


def listed() -> Iterator[str]:
    """Every claim with its rule, and every reading."""
    for claim in stated.claims():
        paper = "in words" if claim.paper is None else f"{claim.paper:g}"
        yield from textwrap.wrap(f"{claim.key:<18}  {claim.says} ({claim.section})", WIDTH, subsequent_indent=" " * 20)
        facts = f"{claim.measured}: paper {paper}; agrees {claim.judged()}; runs: {claim.runs}"
        yield from textwrap.wrap(facts, WIDTH, initial_indent=" " * 20, subsequent_indent=" " * 20)
    yield ""
    for reading in stated.readings():
        facts = f"targets {reading.targets}; deployed in {reading.deployment}; speed {reading.speed} ({reading.why})"
        yield from textwrap.wrap(f"{reading.key:<18}  {facts}", WIDTH, subsequent_indent=" " * 20)


def main(given: list[str]) -> int:
    """Always 0: a difference from the paper is a finding, not a failure."""
    made = parser(__doc__)
    made.add_argument("--list", action="store_true", help="print the claims and readings, which were written down before any run")
    options = made.parse_args(given)
    if options.list:
        print("\n".join(listed()))
        return 0
    card = claims.scorecard(figures(options.results, options.out, options.trials))
    text = json.dumps(card, indent=1, ensure_ascii=False)
    (options.out / "scorecard.json").write_text(text + "\n", encoding="utf-8")
    print("\n".join(entry(claim) for claim in card))
    print(f"\n{totals(card)}\nRules of the verdicts: analysis/paper/verdict.py.")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
