"""Scenarios and campaigns from Python: what gaitctl says of them."""

import csv
import json
import os
import unittest

import support
import numpy as np

import gaitd
from support import scratch


class Scenarios(unittest.TestCase):
    def test_the_verdict_is_that_of_gaitctl(self):
        settings = {"duration": 3.0, "seed": np.int64(2), "commands.0.walk.length": 0.2, "sensors.noise": "nominal"}
        with open(scratch("short.yaml"), "w", encoding="utf-8") as file:
            json.dump({"schema": "gaitd.scenario/1", **support.WALK}, file)
        run = gaitd.run(scratch("short.yaml"), set=settings, log=scratch("a.mcap"))
        told = json.loads(
            support.gaitctl(
                "--json", "run", scratch("short.yaml"), "--set", "duration=3", "--set", "seed=2", "--set",
                "commands.0.walk.length=0.2", "--log", scratch("b.mcap"), code=0 if run.passed else 1,
            )
        )["scenarios"][0]  # fmt: skip
        self.assertEqual(run.passed, told["pass"])
        times = {name for name in run.figures if name in ("wall_seconds", "realtime_factor") or "_us" in name}
        for name, value in told["verdict"]["figures"].items():
            if name not in times:
                self.assertEqual(run.figures[name], value, name)
        self.assertEqual([one.name for one in run.verdict.expectations], ["no_fall", "steps_taken"])
        self.assertEqual(run.verdict.units, told["verdict"]["units"])
        # A run in lockstep is the same to the bit: from Python, as a dict, and by gaitctl.
        np.testing.assert_array_equal(run.log["icp/x"], gaitd.Log(scratch("b.mcap"))["icp/x"])
        as_dict = gaitd.run(support.WALK, set=settings, log=scratch("c.mcap"))
        np.testing.assert_array_equal(run.log["icp/x"], as_dict.log["icp/x"])

    def test_what_does_not_hold_is_no_exception(self):
        too_far = {"no_fall": True, "final_pelvis": {"x": 2, "y": 0, "tolerance": 0.1}}
        run = gaitd.run({**support.WALK, "expect": too_far}, log=scratch("failed.mcap"))
        self.assertFalse(run.passed)
        self.assertEqual([one.name for one in run.verdict.failed()], ["final_pelvis"])

    def test_a_scenario_that_cannot_be_played(self):
        run = gaitd.run("flat-0.36")
        self.assertFalse(run.passed)
        self.assertIn("did you mean 'flat-0.35'", run.problems[0])
        with self.assertRaisesRegex(gaitd.GaitdError, "flat-0.36"):
            run.figures["falls"]
        with self.assertRaisesRegex(gaitd.GaitdError, "no log: .*flat-0.36"):
            run.log
        run = gaitd.run({**support.WALK, "durration": 3})
        self.assertIn("durration", run.problems[0])
        with self.assertRaisesRegex(TypeError, "expected a dict"):
            gaitd.run("stand", set=[1])

    def test_no_programs(self):
        before = os.environ.get("GAITD_BIN")
        os.environ["GAITD_BIN"] = support.SCRATCH
        try:
            with self.assertRaisesRegex(gaitd.ProgramError, "no gaitctl"):
                gaitd.run("stand")
        finally:
            del os.environ["GAITD_BIN"]
            if before is not None:
                os.environ["GAITD_BIN"] = before


class Campaigns(unittest.TestCase):
    def test_the_frame_is_the_table_of_results(self):
        with open(scratch("tiny.yaml"), "w", encoding="utf-8") as file:
            json.dump({"schema": "gaitd.scenario/1", **support.WALK, "duration": 1.0, "commands": [], "expect": {}}, file)
        campaign = {
            "name": "tiny",
            "scenarios": [scratch("tiny.yaml")],
            "set": {"step_adjuster.variant": ["step_plan", "fixed_steps"]},
            "draw": {"model_error.mass_scale.utorso": [0.95, 1.05]},
            "seeds": 2,
            "success": "no_fall",
            "keep_logs": 0,
        }
        frame = gaitd.campaign(campaign, scratch("tiny"))
        with open(scratch("tiny/results.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(frame), 4)
        self.assertEqual(list(frame.columns), list(rows[0]))
        for told, row in zip(frame.to_dict("records"), rows):
            for name, text in row.items():
                value = told[name]
                if isinstance(value, str):
                    self.assertIn(text, (value, json.dumps(value)), name)
                elif text in ("", "nan"):
                    self.assertTrue(np.isnan(value), name)
                else:
                    self.assertEqual(float(value), float(text), name)
        self.assertEqual(set(frame["step_adjuster.variant"]), {"step_plan", "fixed_steps"})
        self.assertTrue(frame["success"].all(), frame.to_csv())
        with open(scratch("tiny/summary.json"), encoding="utf-8") as file:
            self.assertEqual(frame.attrs["summary"], json.load(file))
        # Again: it goes on where it was, at the end.
        self.assertTrue(gaitd.campaign(campaign, scratch("tiny")).equals(frame))
        self.assertTrue(gaitd.results(scratch("tiny")).equals(frame))
        with self.assertRaisesRegex(gaitd.ProgramError, "another"):
            gaitd.campaign({**campaign, "seeds": 3}, scratch("tiny"))

    def test_words_are_words(self):
        os.mkdir(scratch("written"))
        with open(scratch("written/results.csv"), "w", encoding="utf-8") as file:
            file.write('run,a,b,success,icp\n1,None,"""1""",1,0.5\n2,NA,x,0,\n')
        frame = gaitd.results(scratch("written"))
        self.assertEqual(list(frame["a"]), ["None", "NA"])
        self.assertEqual(list(frame["b"]), ["1", "x"])
        self.assertEqual(list(frame["success"]), [1, 0])
        self.assertTrue(np.isnan(frame["icp"][1]))

    def test_a_campaign_that_makes_no_sense(self):
        with self.assertRaisesRegex(gaitd.ProgramError, "scenarioz"):
            gaitd.campaign({"name": "wrong", "scenarioz": ["stand"]}, scratch("wrong"))
        self.assertFalse(os.path.exists(scratch("wrong.campaign.yaml")))


if __name__ == "__main__":
    unittest.main()
