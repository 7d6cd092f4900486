"""Verdicts on the article's numbers: each agrees with results like the article's, and differs with others."""

import unittest

from made_results import NoPictures, results  # first: it knows the folder of the report
from report import seed, seed_rates

DISTANCES = (0, 0.5, 1, 1.5, 2, 5, 10, 30, 40)
LOW, HIGH = seed_rates.PUBLISHED["simple_wins_below"]


def article(policy, distance):
    """µs of a query as the article has it: slowest at 1.5, by the published rates; `simple` is the faster below 22."""
    slowest = 1e6 / seed_rates.PUBLISHED["worst_hz"].get(policy, 1000)
    if distance > HIGH:
        return {"simple": 200, "table": 100}.get(policy, 50)
    return slowest / (1 + abs(distance - 1.5))


def rates(time=article, before_contact=1.5, size="0.8"):
    runs = {f"rate/{size}/{engine}/{policy}/{distance:g}/iterations:1": {"p50_us": time(policy, distance), "tests": 9, "n": 3}
            for engine in seed_rates.ENGINES for policy in seed_rates.POLICIES for distance in DISTANCES}
    return results("seed_bench", runs | {f"before_contact/{size}/iterations:1": {"distance": before_contact}})


def chapter(**how):
    return "\n".join(seed_rates.rates(rates(**how), NoPictures()))


def one(**how):
    return seed_rates.Rates(rates(**how), "0.8")


class Worst(unittest.TestCase):
    def test_the_articles_own_numbers_agree(self):
        for row in seed_rates.worst_verdicts(one()):
            self.assertEqual((row[4], row[8]), ("*Agrees*", "*Agrees*"), row)
        self.assertIn("The place agrees in 2 of 2 rows, the rate in 2.", chapter())

    def test_a_worst_case_where_surfaces_overlap_or_far_apart_differs(self):
        overlap = one(time=lambda policy, distance: 1000 / (1 + distance))
        apart = one(time=lambda policy, distance: 1000 * (1 + distance))
        self.assertEqual({row[4] for row in seed_rates.worst_verdicts(overlap)}, {"*Differs:* surfaces overlap there"})
        self.assertEqual({row[4] for row in seed_rates.worst_verdicts(apart)}, {"*Differs:* farther apart"})

    def test_the_place_is_judged_by_the_policies_of_the_article_alone(self):
        others = one(time=lambda policy, distance: 1e9 if policy in ("tight", "slab") and distance == 0 else article(policy, distance))
        self.assertEqual({row[4] for row in seed_rates.worst_verdicts(others)}, {"*Agrees*"})

    def test_a_rate_differs_where_it_is_twice_as_fast_or_half(self):
        for factor in (2.5, 0.4):
            made = one(time=lambda policy, distance: article(policy, distance) / factor)
            self.assertEqual({row[8] for row in seed_rates.worst_verdicts(made)}, {"*Differs*"})

    def test_each_policy_has_its_own_rate(self):
        made = one(time=lambda policy, distance: article(policy, distance) / (3 if policy == "simple" else 1))
        self.assertEqual({row[1]: row[8] for row in seed_rates.worst_verdicts(made)}, {"`table`": "*Agrees*", "`simple`": "*Differs*"})


class Lead(unittest.TestCase):
    def test_who_leads_as_published_agrees_without_a_reason(self):
        self.assertIn("*Agrees:* `simple` is ahead at 7 of 7 distances below 20, `table` at 2 of 2 above 25.", chapter())
        self.assertNotIn("a constant array", chapter())

    def test_table_ahead_everywhere_differs_with_the_reason(self):
        said = chapter(time=lambda policy, _: {"simple": 2, "table": 1}.get(policy, 1))
        self.assertIn("*Differs:* `simple` is ahead at 0 of 7 distances below 20, `table` at 2 of 2 above 25.", said)
        self.assertIn("Below 20 `table` is ahead with 0.8: the table is a constant array", said)

    def test_simple_ahead_everywhere_differs_and_that_is_no_lead_of_the_table(self):
        said = chapter(time=lambda policy, _: {"simple": 1, "table": 2}.get(policy, 1))
        self.assertIn("*Differs:* `simple` is ahead at 7 of 7 distances below 20, `table` at 0 of 2 above 25.", said)
        self.assertNotIn("a constant array", said)

    def test_a_lead_within_the_noise_is_none(self):
        self.assertIn("*Differs:* `simple` is ahead at 0 of 7", chapter(time=lambda policy, _: {"simple": 1, "table": 1.02}.get(policy, 1)))


class Cubic(unittest.TestCase):
    def test_cubic_counts_agree_and_need_no_surface(self):
        said = seed._cubic_verdict(2.9, 2.7, 30, 2.9)
        self.assertIn("*Agrees:* cubic in l/s, more than square, are voxels and time.", said)
        for reason in ("surface", "triangles", "only the array"):
            self.assertNotIn(reason, said)

    def test_square_counts_differ_because_of_the_surface(self):
        said = seed._cubic_verdict(2.0, 1.2, 30, 2.1)
        self.assertIn("*Differs:* neither voxels nor time are cubic in l/s.", said)
        for reason in ("because a surface has two dimensions", "30 ms at any voxel size", "only the array"):
            self.assertIn(reason, said)


class Octree(unittest.TestCase):
    def said(self, above):
        runs = {f"octree/{cells}/iterations:1": {"cells": cells, "octree_ms": ms, "leaves": cells, "n": 3}
                for cells, ms in ((60, 1), (64, 1), (65, above), (70, above))}
        return "\n".join(seed._octree(results("seed_bench", runs), NoPictures()))

    def test_a_jump_at_a_power_of_two_agrees_and_none_differs(self):
        self.assertIn("*Agrees, though", self.said(2))
        self.assertIn("*Differs:*", self.said(1))
        self.assertIn("from 64 to 65 voxels by +100 %", self.said(2))


class Spheres(unittest.TestCase):
    def said(self, table_us):
        runs = {f"levels/{policy}/{level}/iterations:1": {"nodes": 1, "leaf_balls": 1, "make_us": table_us if policy == "table" else 10, "n": 3}
                for policy in seed.POLICIES for level in (0, 1)}
        return "\n".join(seed._volumes(results("seed_bench", runs), NoPictures()))

    def test_the_tables_spheres_are_dearer_or_not(self):
        self.assertIn("*Agrees:* spheres by the table take 2.00 times as long", self.said(20))
        self.assertIn("*Differs:* spheres by the table take no longer", self.said(10))


class Saved(unittest.TestCase):
    def said(self, saved_us):
        runs = {f"saved/0.8/simple/{source}/0/iterations:1": {"p50_us": us, "tests": 9, "octree_MB": 1, "saved_MB": 8, "ball_bytes": 32}
                for source, us in (("on_the_fly", 100), ("saved", saved_us))}
        return "\n".join(seed._saved(results("seed_bench", runs)))

    def test_saving_that_pays_agrees(self):
        self.assertIn("*Agrees:* saving pays.", self.said(80))
        self.assertNotIn("slower", self.said(80))

    def test_saving_that_gains_nothing_differs_and_is_no_loss(self):
        self.assertIn("*Differs:* saving does not always pay.", self.said(98))
        self.assertNotIn("slower", self.said(98))

    def test_saving_that_loses_is_bold_with_its_reason(self):
        said = self.said(125)
        self.assertIn("| **0.80** |", said)
        self.assertIn("**With saved spheres these are slower**: `simple` at 0.8 mm and distance 0 (**0.80**); "
                      "a saved ball is read from memory, 32 bytes a node.", said)


class Voxels(unittest.TestCase):
    def said(self, times):
        """With that many times the published voxels at equal l/s."""
        run = {"extent": 100, "triangles": 9, "nodes": 9, "cells": 9, "voxels_ms": 1, "octree_ms": 1, "MB": 1, "n": 3, "leaves": 9}
        published = seed.PUBLISHED["voxels_by_size"]
        runs = {f"voxels/{size}": run | {"leaves": 1 / float(size) ** 2} for size in ("1", "0.5", "0.2")}
        runs |= {f"scaled/{size}": run | {"leaves": times * count} for size, count in published.items()}
        return "\n".join(seed._voxels(results("seed_bench", runs), NoPictures()))

    def test_as_many_voxels_as_published_agree_and_three_times_as_many_differ(self):
        self.assertIn("*Agrees:* at equal l/s", self.said(1.1))
        self.assertIn("*Differs:* at equal l/s", self.said(3))


if __name__ == "__main__":
    unittest.main()
