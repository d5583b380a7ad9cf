"""The scorecard, on figures that are known."""

import unittest

from paper import claims
from paper.verdict import AGREES, CANNOT_SAY, DIFFERS
from tests import made_up


def verdicts(figures: dict) -> dict[str, str]:
    """Each claim's verdict."""
    return {claim["claim"]: claim["verdict"] for claim in claims.scorecard(figures)}


class Scorecard(unittest.TestCase):
    def test_without_any_run_no_claim_can_be_said(self) -> None:
        self.assertEqual(set(verdicts({}).values()), {CANNOT_SAY})

    def test_every_claim_is_there_once_whether_run_or_not(self) -> None:
        full = {**made_up.figures(), "bandwidth": made_up.bandwidth()}
        self.assertEqual(list(verdicts({})), list(verdicts(full)))
        self.assertEqual(len(claims.scorecard({})), len(verdicts({})))

    def test_the_papers_own_figures_agree(self) -> None:
        found = verdicts({**made_up.figures(), "bandwidth": made_up.bandwidth()})
        open_by_nature = {name for name in found if "optimum" in name or "reading of bandwidth" in name}
        flat = {"requests and responses cost more the more neighbours a robot has"}
        for name, verdict in found.items():
            self.assertEqual(verdict, CANNOT_SAY if name in open_by_nature | flat else AGREES, name)

    def test_medians_that_rise_once_do_not_fall(self) -> None:
        figures = made_up.figures()
        figures["completion"]["60x3"]["median"] = made_up.near(1280)
        self.assertEqual(verdicts(figures)["fewer steps the more robots and links"], DIFFERS)

    def test_one_sample_in_two_pieces_breaks_the_claim_of_connectivity(self) -> None:
        figures = made_up.figures()
        figures["connectivity"]["40x2"].update(least_of_all=0.0, connected_trials=34)
        self.assertEqual(verdicts(figures)["λ₂ > 0 throughout"], DIFFERS)

    def test_only_what_was_fitted_is_called_calibrated(self) -> None:
        fitted = [claim["claim"] for claim in claims.scorecard(made_up.figures()) if claim["kind"] == claims.CALIBRATED]
        self.assertEqual(len(fitted), 2)
        self.assertIn("20 robots", fitted[0])
        self.assertIn("40 robots", fitted[1])

    def test_a_reading_is_off_by_its_worst_number(self) -> None:
        runs = made_up.bandwidth()
        self.assertEqual(claims.misfit(runs, "sent, with headers"), 1.0)
        runs["50"]["readings"]["sent, with headers"]["median"] = 25.0
        self.assertEqual(claims.misfit(runs, "sent, with headers"), 4.0)
