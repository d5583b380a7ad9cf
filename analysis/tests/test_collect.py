"""What is read from a results folder."""

import tempfile
import unittest
from pathlib import Path

from paper import collect
from paper.folder import Folder
from tests import made_up


class Collect(unittest.TestCase):
    def setUp(self) -> None:
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.path = Path(scratch.name)

    def folder(self) -> Folder:
        made_up.folder(self.path / "run")
        return Folder(self.path / "run")

    def test_the_optimum_is_to_where_robots_were_at_completion(self) -> None:
        # Completed at step 25, 2.5 s: between x = 2.0 m and 2.4 m. 1.2 m at 0.5 m/s take 2.4 s.
        ways = collect._ways(self.folder(), 0)
        self.assertAlmostEqual(ways["same_robot"], 24.0, places=5)

    def test_a_trial_that_did_not_complete_is_measured_to_its_end(self) -> None:
        # 2 m, at the end of its 4 s, a second after the last sample.
        self.assertAlmostEqual(collect._ways(self.folder(), 1)["same_robot"], 40.0, places=5)

    def test_after_the_last_sample_robots_go_on_to_where_they_end(self) -> None:
        path = collect.way(self.folder(), 1)
        for time, x in ((3.0, 2.4), (3.5, 2.7), (4.0, 3.0)):
            self.assertAlmostEqual(collect.places_at(path, time)[1][0], x, places=6)

    def test_a_robot_is_on_the_line_between_two_samples(self) -> None:
        samples = self.folder().table("trajectories").filter(trial=0)
        for time, x in ((0.0, 1.0), (0.5, 1.25), (3.0, 2.4), (9.0, 2.4)):
            self.assertAlmostEqual(collect.places_at(samples, time)[1][0], x, places=6)

    def test_unfinished_results_do_not_count(self) -> None:
        made_up.folder(self.path / "half", finished=False)
        self.assertFalse(Folder(self.path / "half").is_complete(2))
        done = self.folder()
        self.assertTrue(done.is_complete(2))
        self.assertFalse(done.is_complete(3))
        self.assertFalse(Folder(self.path / "none").is_complete(1))

    def test_a_section_without_all_its_runs_stays_as_it_was(self) -> None:
        sections, sources = collect.collect(self.path, {"completion": {"kept": True}})
        self.assertEqual(sections, {"completion": {"kept": True}})
        self.assertTrue(sources["completion"].startswith("as committed"))
        self.assertTrue(sources["faults"].startswith("absent"))

    def test_a_ring_of_targets_begins_on_the_x_axis(self) -> None:
        found = collect.targets({"Ring": {"count": 4, "radius": 4.5, "links": 1}})
        for place, wanted in zip(found, [[4.5, 0], [0, 4.5], [-4.5, 0], [0, -4.5]], strict=True):
            self.assertEqual([abs(round(x - y, 6)) for x, y in zip(place, wanted, strict=True)], [0, 0])

    def test_what_is_written_is_read_back(self) -> None:
        figures = {"a": {"median": {"value": 1.5, "ci95": [None, 2.0], "n": 3}, "steps": [1, None]}, "b": {}}
        collect.write(self.path / "figures.json", figures)
        self.assertEqual(collect.read(self.path / "figures.json"), figures)
        self.assertEqual(collect.read(self.path / "absent.json"), {})
