"""The list of runs."""

import unittest
from pathlib import Path

from paper import evaluation
from paper.draw import faults
from tests import made_up


class Evaluation(unittest.TestCase):
    def test_no_two_runs_share_a_folder(self) -> None:
        runs = {}
        for group in evaluation.sets().values():
            for run in group:
                self.assertEqual(runs.setdefault(run.name, run), run)

    def test_every_scenario_is_shipped(self) -> None:
        for run in evaluation.chosen(list(evaluation.sets())):
            self.assertTrue(run.scenario.is_file(), run.scenario)

    def test_a_run_that_two_figures_need_is_run_once(self) -> None:
        names = [run.name for run in evaluation.chosen(["completion", "bandwidth", "connectivity"])]
        self.assertEqual(len(names), len(set(names)))
        self.assertEqual(len(names), 14)

    def test_a_command_names_scenario_trials_folder_and_overrides(self) -> None:
        run = evaluation.other_hazard(40, 70, 0.0002).run
        command = run.command(Path("desim"), Path("out"), 5, ("--quiet",))
        self.assertEqual(command[0:2], ["desim", "scenario"])
        self.assertEqual(command[3:7], ["--trials", "5", "--out", "out/faults_40x2_p70_h2"])
        self.assertEqual(command[7:], ["--set", "faults=[Fallible(share: 0.7, hazard: 0.0002)]", "--quiet"])


class Drawing(unittest.TestCase):
    def test_a_trial_that_did_not_complete_takes_longer_than_any_limit(self) -> None:
        low, median, high = faults.spread(made_up.fault_point(2067, 9))
        self.assertTrue(low == median < high == faults.NEVER)
