#!/usr/bin/env python3
"""Runs every example of results/README.md and holds what it prints against summary.json.

    python analysis/check_examples.py FOLDER

FOLDER holds `results/loss20`, of an even number of trials, `results/crash_and_recover` and the study `results/status_interval`. Blocks in R are run where there is R, and said to be left out where there is
none. DuckDB's command line must be beside the Python that runs this, or on the path.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

README = pathlib.Path(__file__).resolve().parent.parent / "results" / "README.md"
COMMANDS = {
    "python": [sys.executable, "-c"],
    "sql": ["duckdb", "-batch", "-csv", "-c"],
    "r": ["Rscript", "--vanilla", "-e"],
}
TOLERANCE = 5e-4
"""Tables round what they print."""


def blocks(text):
    """(language, code) of each block."""
    return re.findall(r"^```(python|sql|r)\n(.*?)^```", text, flags=re.MULTILINE | re.DOTALL)


def examples(text):
    """(question, language, code) of each block under a question; blocks before the first one are put before those of their language."""
    preludes = {}
    for section in re.split(r"^### ", text, flags=re.MULTILINE):
        question, _, body = section.partition("\n")
        for language, code in blocks(body.split("\n## Checking")[0]):
            if question.endswith("?"):
                yield question, language, preludes.get(language, "") + code
            else:
                preludes[language] = code


def expected(folder):
    """What the summaries say, by a word of the question."""

    def summary(name):
        return json.loads((folder / "results" / name / "summary.json").read_text(encoding="utf-8"))

    mission, detection = summary("loss20"), summary("crash_and_recover")["detection"]
    return {
        "cost": [topic["tx_bytes_per_step"]["mean"]["value"] for topic in mission["bandwidth"]["by_topic"].values()],
        "complete": [mission["steps_to_completion"]["median"]["value"]],
        "noticed": [
            detection["failures"]["detected"],
            detection["detection_time_s"]["value"],
            detection["query_accuracy"]["value"],
        ],
    }


def missing(printed, figures):
    """The figures that are not among the numbers printed."""
    numbers = [float(number) for number in re.findall(r"(?<![\w.])\d+(?:\.\d+)?(?:e[+-]\d+)?", printed)]
    return [figure for figure in figures if not any(abs(number - figure) <= TOLERANCE * figure for number in numbers)]


def run(language, code, folder):
    """What a block prints, or why it does not run."""
    path = f"{pathlib.Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    command = COMMANDS[language]
    program = shutil.which(command[0], path=path) or command[0]
    result = subprocess.run(
        [program, *command[1:], code], cwd=folder, env={**os.environ, "PATH": path}, capture_output=True, text=True, check=False
    )
    return result.stdout, result.stderr if result.returncode else None


def main(arguments):
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    folder = pathlib.Path(arguments[0])
    figures, status, ran = expected(folder), 0, 0
    described, reading = README.read_text(encoding="utf-8").split("\n## Reading them\n")
    for language, code in blocks(described):
        printed, failure = run(language, code, folder)
        print(f"{code.splitlines()[1]}: {failure or 'runs'}")
        status = 1 if failure or not printed else status
    for question, language, code in examples(reading):
        if language == "r" and shutil.which("Rscript") is None:
            print(f"{question} {language}: left out, there is no R here")
            continue
        ran += 1
        printed, failure = run(language, code, folder)
        wanted = next(wanted for word, wanted in figures.items() if word in question)
        absent = missing(printed, wanted)
        if failure or absent:
            status = 1
            print(f"{question} {language}: {failure or f'does not print {absent}'}\n{code}\n{printed}")
        else:
            print(f"{question} {language}: prints the figures of the summary")
    if ran < 3 * len(figures):
        print(f"only {ran} examples were found")
        status = 1
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
