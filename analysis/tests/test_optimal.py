"""The optimal time, by hand and against all assignments."""

import itertools
import math
import random
import unittest

from paper.optimal import best_assignment, same_robot, steps


class Optimal(unittest.TestCase):
    def test_the_last_robot_to_arrive_decides(self) -> None:
        self.assertEqual(same_robot([(0, 0), (1, 0)], [(3, 4), (1, 1)]), 5.0)

    def test_five_metres_at_a_tenth_of_a_metre_a_second_are_500_steps(self) -> None:
        self.assertAlmostEqual(steps(5.0, 0.1, 0.1), 500)

    def test_robots_that_would_cross_are_swapped(self) -> None:
        starts, places = [(0.0, 0.0), (1.0, 0.0)], [(1.0, 0.0), (0.0, 0.0)]
        self.assertEqual(same_robot(starts, places), 1.0)
        self.assertEqual(best_assignment(starts, places), 0.0)

    def test_a_robot_without_a_place_may_take_another_ones(self) -> None:
        self.assertEqual(best_assignment([(0.0, 0.0), (5.0, 0.0)], [(6.0, 0.0)]), 1.0)

    def test_it_is_the_best_of_all_assignments(self) -> None:
        draw = random.Random(1)
        for _ in range(50):
            starts = [(draw.random(), draw.random()) for _ in range(6)]
            places = [(draw.random(), draw.random()) for _ in range(4)]
            chosen = itertools.permutations(starts, len(places))
            best = min(max(map(math.dist, robots, places)) for robots in chosen)
            self.assertAlmostEqual(best_assignment(starts, places), best)

    def test_no_place_takes_no_time(self) -> None:
        self.assertEqual(best_assignment([(0.0, 0.0)], []), 0.0)
        self.assertEqual(same_robot([], []), 0.0)
