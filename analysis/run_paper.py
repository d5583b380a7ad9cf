#!/usr/bin/env python3
"""Runs the paper's evaluation: every scenario of every figure, 35 trials each.

    cargo build --release --locked
    python analysis/run_paper.py                       # everything, into results/
    python analysis/run_paper.py --only completion     # one figure's runs
    python analysis/run_paper.py --quick               # 5 trials, into results/paper-quick/: a look, no evidence

What is done stays done: run it again after an interruption and it goes on where it stopped.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from pathlib import Path

from paper.evaluation import ROOT, TRIALS, Run, chosen, sets

QUICK_TRIALS = 5


def default_binary() -> Path:
    """Where cargo puts the release build."""
    return Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release" / "desim"


def arguments(given: list[str]) -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", choices=list(sets()), metavar="SET", help=f"of {', '.join(sets())}")
    parser.add_argument("--quick", action="store_true", help=f"{QUICK_TRIALS} trials instead of {TRIALS}")
    parser.add_argument("--results", type=Path, help="folder of the results folders [default: results]")
    parser.add_argument("--binary", type=Path, default=default_binary(), help="desim [default: the release build]")
    parser.add_argument("--jobs", type=int, help="trials at a time [default: one for each processor]")
    parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE", help="for every run, as desim's")
    parser.add_argument("--force", action="store_true", help="delete results of other scenarios that are in the way")
    parser.add_argument("--dry-run", action="store_true", help="say what would run")
    return parser.parse_args(given)


def extra(options: argparse.Namespace) -> tuple[str, ...]:
    """What every run's command line gets besides its own."""
    overrides = [argument for override in options.set for argument in ("--set", override)]
    jobs = ["--jobs", str(options.jobs)] if options.jobs else []
    return ("--driver", "inline", "--quiet", *overrides, *jobs, *(["--force"] if options.force else []))


def run(position: str, task: Run, command: list[str]) -> bool:
    """Runs one scenario; whether it went well."""
    print(f"{position} {task.name}", end="", flush=True)
    began = time.monotonic()
    finished = subprocess.run(command, cwd=ROOT, check=False, capture_output=True, text=True)
    if finished.returncode == 0:
        print(f"  {time.monotonic() - began:.0f} s", flush=True)
        return True
    print(f"  failed, exit status {finished.returncode}\n  {' '.join(command)}\n{finished.stderr}", flush=True)
    return False


def main(given: list[str]) -> int:
    """Exit status 0 if every run went well, 130 if interrupted, else 1."""
    options = arguments(given)
    trials = QUICK_TRIALS if options.quick else TRIALS
    results = options.results or ROOT / "results" / ("paper-quick" if options.quick else "")
    tasks = list(chosen(options.only or list(sets())))
    print(f"{len(tasks)} scenarios, {trials} trials each, into {results}")
    failed = []
    for number, task in enumerate(tasks, 1):
        command = task.command(options.binary, results.resolve(), trials, extra(options))
        if options.dry_run:
            print(" ".join(command))
        elif not run(f"[{number}/{len(tasks)}]", task, command):
            failed.append(task.name)
    if failed:
        print(f"{len(failed)} failed: {', '.join(failed)}")
    return 1 if failed else 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        print("\ninterrupted: finished trials are kept; the same command goes on")
        sys.exit(130)
