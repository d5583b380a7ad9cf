"""The list of claims: whole, and of one mind with the rules."""

import unittest

from paper import reference, stated, verdict

MARGINS = {"number": (verdict.MARGIN, 2 * verdict.MARGIN), "same": (verdict.SAME,)}
"""What is granted where the paper has a number: twice as much where it says "about"."""


class Claims(unittest.TestCase):
    def setUp(self) -> None:
        self.claims = list(stated.claims())

    def test_there_are_as_many_as_the_paper_has_and_each_once(self) -> None:
        self.assertGreaterEqual(len(self.claims), 40)
        self.assertEqual(len({claim.key for claim in self.claims}), len(self.claims))

    def test_margins_are_those_of_the_rules(self) -> None:
        for claim in self.claims:
            self.assertIn(claim.margin, MARGINS.get(claim.rule, (claim.margin,)), claim.key)

    def test_every_claim_says_where_it_stands_what_is_measured_and_in_which_runs(self) -> None:
        for claim in self.claims:
            for words in (claim.section, claim.says, claim.measured, claim.runs, claim.judged()):
                self.assertTrue(words, claim.key)

    def test_the_papers_numbers_are_those_of_the_other_tables(self) -> None:
        paper = {claim.key: claim.paper for claim in self.claims}
        medians = reference.completion()
        for label, steps in medians.items():
            self.assertEqual(paper[f"median_{label}"], steps)
        for label in list(medians)[1:]:
            self.assertAlmostEqual(paper[f"ratio_{label}"], medians[label] / medians["20x1"], places=3)
        for (robots, _), steps in reference.faults().items():
            self.assertEqual(paper[f"faults_median_{robots}"], steps)
        bytes_a_step = reference.bandwidth()
        self.assertEqual([paper["bytes_least"], paper["bytes_most"]], [bytes_a_step["min"], bytes_a_step["max"]])
        self.assertEqual(paper["bytes_median_40"], bytes_a_step["median"])

    def test_each_reading_is_there_once(self) -> None:
        keys = [reading.key for reading in stated.readings()]
        self.assertEqual(len(set(keys)), len(keys))
        self.assertEqual(keys[0], "axes_widening")


if __name__ == "__main__":
    unittest.main()
