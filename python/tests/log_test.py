"""Logs by signal: the same values as gaitctl exports, to the bit, and nothing but sound ones."""

import json
import os
import shutil
import unittest

import support
import numpy as np
import pandas

import gaitd
from support import scratch


def setUpModule():
    global run
    run = gaitd.run(support.WALK, log=scratch("walk.mcap"))
    assert run.verdict is not None, run.problems


def copy(name):
    path = scratch(name)
    shutil.copy(run.log_file, path)
    return path


class Values(unittest.TestCase):
    def test_equal_to_the_export_to_the_bit(self):
        log = run.log
        support.gaitctl("log", "export", run.log_file, "-o", scratch("all.csv"))
        words = {name: str for name, signal in log.signals.items() if signal.words}
        csv = pandas.read_csv(scratch("all.csv"), float_precision="round_trip", dtype=words, keep_default_na=False,
                              na_values={name: ["nan", "NaN", ""] for name in log if name not in words})
        self.assertEqual(list(csv.columns), list(log))
        self.assertEqual(len(csv), log.ticks)
        self.assertGreater(log.ticks, 3000)
        for name, signal in log.signals.items():
            values = log[name]
            self.assertEqual(values.dtype, signal.dtype, name)
            self.assertEqual(values.shape, (log.ticks,), name)
            if signal.kind == "enumeration":
                told = [signal.words[value] if value >= 0 else "" for value in values]
                self.assertEqual(told, list(csv[name]), name)
            elif signal.kind == "real":
                told, expected = values, csv[name].to_numpy(float)
                same = (told.view(np.int64) == expected.view(np.int64)) | (np.isnan(told) & np.isnan(expected))
                self.assertTrue(same.all(), name)
            else:
                np.testing.assert_array_equal(values.astype(float), csv[name].to_numpy(float), name)

    def test_rows_are_those_of_the_whole(self):
        log = run.log
        whole = log["com/z"]
        for rows in (slice(None), slice(10, 20), slice(2000, 2100), slice(1, None, 7), slice(5, 5), slice(None, None, 4096),
                     slice(-30, None), slice(100, 3000, 2047)):  # fmt: skip
            np.testing.assert_array_equal(log.read("com/z", rows=rows), whole[rows], str(rows))
        with self.assertRaises(ValueError):
            log.read("com/z", rows=slice(None, None, -1))
        between = log.rows_between(1.0, 1.5)
        self.assertEqual(log.read("time", rows=between)[[0, -1]].tolist(), [1.0, 1.5])

    def test_frames(self):
        log = run.log
        frame = log.frame(["com/?", "gait/phase", "foot/*/contact", "tick", "toe_off/active"], rows=slice(0, None, 10))
        self.assertEqual(list(frame)[:4], ["com/x", "com/y", "com/z", "gait/phase"])
        self.assertIn("foot/right/contact", frame)
        np.testing.assert_array_equal(frame["com/x"], log["com/x"][::10])
        np.testing.assert_array_equal(frame.index, log.time[::10])
        self.assertEqual(set(frame["gait/phase"].unique()), {"stand", "transfer", "swing"})
        self.assertEqual(frame["tick"].dtype, np.int64)
        self.assertEqual(frame["toe_off/active"].dtype, bool)

    def test_what_is_not_there_is_a_key_error_that_suggests(self):
        log = run.log
        with self.assertRaises(KeyError) as caught:
            log["icp/xx"]
        self.assertIsInstance(caught.exception, gaitd.MissingSignal)
        self.assertEqual(str(caught.exception), "no signal 'icp/xx'; did you mean 'icp/x'?")
        with self.assertRaisesRegex(KeyError, "nothing/"):
            log.frame(["com/*", "nothing/*"])
        self.assertNotIn("icp/xx", log)
        self.assertIn("icp/x", log)

    def test_what_makes_no_sense_is_told_in_the_words_of_the_argument(self):
        log = run.log
        for kind, words, call in (
            (TypeError, "name of a signal", lambda: log[3]),
            (TypeError, "name of a signal", lambda: log[None]),
            (TypeError, "expected a slice", lambda: log.read("icp/x", rows=(5, 10))),
            (TypeError, "expected a slice", lambda: log.positions("pelvis", rows=7)),
            (ValueError, "start=nan", lambda: log.rows_between(float("nan"), 2.0)),
            (ValueError, "end=nan", lambda: log.rows_between(0.0, float("nan"))),
            (ValueError, "at least 1", lambda: log.rows_between(0.0, 1.0, every=0)),
            (ValueError, "three numbers", lambda: log.positions("pelvis", (0, 0))),
            (ValueError, "three numbers", lambda: log.model.positions("pelvis", np.zeros(6), np.zeros(30), (0, 0))),
        ):
            with self.assertRaisesRegex(kind, words):
                call()

    def test_events_and_metadata(self):
        log = run.log
        told = json.loads(support.gaitctl("--json", "log", "info", run.log_file))
        self.assertEqual(len(log.events), len(told["events"]))
        walks = [event for event in log.events if event.kind == "command"]
        self.assertEqual(walks[0].text["command"], "walk")
        self.assertEqual(log.metadata["robot"], "atlas")
        self.assertEqual(log.metadata["ticks"], str(log.ticks))
        self.assertEqual(log.duration, told["duration"])
        self.assertEqual(log.damage, [])


class Robot(unittest.TestCase):
    def test_the_pelvis_is_where_the_signals_say(self):
        for base, prefix in (("estimate", "pelvis/"), ("truth", "truth/pelvis/")):
            expected = np.stack([run.log[prefix + axis] for axis in "xyz"], 1)
            np.testing.assert_allclose(run.log.positions("pelvis", base=base), expected, atol=1e-12)

    def test_the_soles_are_where_the_signals_say(self):
        # Of robot.yaml: the sole frame in the link of the foot.
        for side, link, sole_in_link in (("left", "l_foot", (0.0426, 0.0017, -0.07645)),
                                         ("right", "r_foot", (0.0426, -0.0017, -0.07645))):  # fmt: skip
            sole = np.stack([run.log[f"foot/{side}/{axis}"] for axis in "xyz"], 1)
            found = run.log.positions(link, sole_in_link)
            np.testing.assert_allclose(found, sole, atol=1e-9)
            thinned = run.log.positions(link, sole_in_link, rows=slice(100, 3000, 50))
            np.testing.assert_array_equal(thinned, found[100:3000:50])

    def test_rotations_are_rotations_and_the_model_is_the_robot(self):
        log = run.log
        poses = log.poses("l_hand", rows=slice(None, None, 500))
        rotations = poses[:, :3, :3]
        np.testing.assert_allclose(rotations @ rotations.transpose(0, 2, 1), np.broadcast_to(np.eye(3), rotations.shape),
                                   atol=1e-12)  # fmt: skip
        self.assertEqual(len(log.model.joints), 30)
        self.assertAlmostEqual(log.model.total_mass, 175.118, 2)
        one = log.model.poses("l_hand", np.zeros(6), np.zeros(30))
        self.assertEqual(one.shape, (4, 4))
        with self.assertRaisesRegex(KeyError, "did you mean 'l_hand'"):
            log.positions("l_hnd")
        with self.assertRaises(ValueError):
            log.model.poses("l_hand", np.zeros((3, 6)), np.zeros((2, 30)))

    def test_the_verdict_is_that_of_the_run(self):
        verdict = run.log.verdict()
        self.assertEqual(verdict.expectations, run.verdict.expectations)
        shared = {name: value for name, value in verdict.figures.items() if name not in ("wall_seconds",)}
        self.assertEqual(shared, {name: run.verdict.figures[name] for name in shared})


class Damage(unittest.TestCase):
    def test_a_log_that_was_cut_off(self):
        path = scratch("cut.mcap")
        with open(run.log_file, "rb") as whole, open(path, "wb") as cut:
            cut.write(whole.read()[: os.path.getsize(run.log_file) * 6 // 10])
        with self.assertRaises(gaitd.DamagedLog) as caught:
            gaitd.Log(path)
        told = json.loads(support.gaitctl("--json", "log", "info", path, code=4))
        self.assertEqual(caught.exception.findings, told["damage"])
        self.assertIn("cut off at byte", str(caught.exception))
        log = gaitd.Log(path, damaged="read")
        self.assertEqual(log.ticks, told["ticks"])
        self.assertTrue(0 < log.ticks < run.log.ticks)
        np.testing.assert_array_equal(log["icp/y"], run.log["icp/y"][: log.ticks])
        self.assertFalse(log.verdict().passed)

    def test_what_is_no_log(self):
        for name, content in (("none.mcap", None), ("text.mcap", b"no log at all"), ("empty.mcap", b"")):
            path = scratch(name)
            if content is not None:
                with open(path, "wb") as file:
                    file.write(content)
            told = json.loads(support.gaitctl("--json", "log", "info", path, code=1))["error"]["message"]
            with self.assertRaises(gaitd.LogError) as caught:
                gaitd.Log(path)
            self.assertEqual(str(caught.exception), told)
            self.assertFalse(os.path.exists(path + ".columns"))


class Columns(unittest.TestCase):
    def test_the_log_is_read_once_and_again_when_it_changed(self):
        path = copy("once.mcap")
        self.assertTrue(gaitd.Log(path)._native.read_anew)
        log = gaitd.Log(path)
        self.assertFalse(log._native.read_anew)
        self.assertEqual(log.columns_file, os.path.realpath(path) + ".columns")
        os.utime(path, ns=(0, os.stat(path).st_mtime_ns + 1))
        self.assertTrue(gaitd.Log(path)._native.read_anew)

    def test_nothing_stays_where_nothing_is_to_be_kept(self):
        path = copy("unkept.mcap")
        log = gaitd.Log(path, keep=False)
        self.assertIsNone(log.columns_file)
        self.assertFalse(os.path.exists(path + ".columns"))
        np.testing.assert_array_equal(log["com/x"], run.log["com/x"])

    def test_columns_that_are_damaged_are_never_taken_for_sound(self):
        path = copy("flipped.mcap")
        gaitd.Log(path)
        with open(path + ".columns", "rb") as file:
            sound = file.read()
        expected = {name: run.log[name] for name in ("com/x", "gait/phase", "joint/l_leg_kny/torque")}
        generator = np.random.default_rng(1)
        places = [0, 5, len(sound) - 1, len(sound) - 20, *generator.integers(0, len(sound), 40)]
        cut = range(0, len(places), 3)
        refused = renewed = 0
        for index, place in enumerate(places):
            damaged = bytearray(sound)
            damaged[place] ^= 1 << int(generator.integers(8))
            with open(path + ".columns", "wb") as file:
                file.write(damaged[:place] if index in cut else damaged)
            log = gaitd.Log(path)
            renewed += log._native.read_anew
            for name, values in expected.items():
                try:
                    np.testing.assert_array_equal(log[name], values)
                except gaitd.LogError as error:
                    self.assertIn("delete them and open the log again", str(error))
                    refused += 1
        self.assertGreaterEqual(renewed, len(cut))
        # A place among 284 signals is seldom in one that is read: flip all blocks.
        damaged = bytearray(sound)
        for place in range(100, len(sound) * 9 // 10, 64):
            damaged[place] ^= 0xFF
        with open(path + ".columns", "wb") as file:
            file.write(damaged)
        with self.assertRaises(gaitd.LogError):
            gaitd.Log(path)["com/x"]

    def test_a_folder_that_cannot_be_written_to(self):
        os.mkdir(scratch("taken"))
        path = copy("taken/walk.mcap")
        os.mkdir(path + ".columns")  # so that even root cannot
        first = gaitd.Log(path)
        self.assertTrue(first.columns_file.startswith(os.environ["XDG_CACHE_HOME"]), first.columns_file)
        self.assertFalse(gaitd.Log(path)._native.read_anew)
        np.testing.assert_array_equal(first["com/x"], run.log["com/x"])


if __name__ == "__main__":
    unittest.main()
