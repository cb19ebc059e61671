"""A robot of a private gaitd, commanded from Python."""

import gc
import os
import threading
import unittest

import numpy as np

import support
import gaitd
from support import scratch


def setUpModule():
    global robot
    robot = gaitd.simulate(log=scratch("live.mcap"), clock="lockstep")
    unittest.addModuleCleanup(robot.close)


class Commands(unittest.TestCase):
    def tearDown(self):
        if robot.status()["state"] == "fault":
            robot.reset()
            robot.sim_reset()
        robot.wait("standing")

    def test_walks_three_steps_and_tells_of_it(self):
        events = robot.events(timeout=0.5)
        before = robot.status()["pelvis"]["x"]
        taken = robot.walk(3, length=0.3)
        self.assertIsNone(taken["note"])
        status = robot.wait("standing", timeout=60)
        self.assertEqual(status["state"], "standing")
        self.assertGreater(status["tick"], taken["tick"])
        self.assertEqual(status["footsteps_ahead"], 0)
        self.assertAlmostEqual(status["pelvis"]["x"] - before, 0.9, delta=0.1)
        told = [event for event in events if event.tick >= taken["tick"]]  # not the end of the walk before
        commands = [event for event in told if event.kind == "command"]
        self.assertEqual([(event.text["command"], event.tick) for event in commands], [("walk", taken["tick"])])
        states = [event.text["state"] for event in told if event.kind == "state"]
        self.assertEqual(states, ["walking", "standing"])

    def test_a_refusal_is_in_the_words_of_gaitd(self):
        with self.assertRaises(gaitd.Refused) as caught:
            robot.walk(2, length=1.9)
        self.assertRegex(str(caught.exception), "footstep 1 .*ahead of the other foot")
        self.assertEqual(caught.exception.code, -32000)
        self.assertIn("tick", caught.exception.data)
        with self.assertRaises(gaitd.Refused) as caught:
            robot.walk(2, length="far")
        self.assertEqual(caught.exception.code, -32602)
        with self.assertRaises(gaitd.Refused):
            robot.call("walk", steps=2, lenght=0.3)
        with self.assertRaisesRegex(ValueError, "standing"):
            robot.wait("stading")

    def test_goes_over_ground_that_it_is_told_of(self):
        robot.sim_reset()
        robot.wait("standing")
        self.assertIsNone(robot.map())
        heights = np.zeros((100, 150))
        heights[:, 75:100] = 0.1  # a board of half a metre, 0.5 m ahead
        heights[0, 0] = np.nan
        told = gaitd.HeightMap(heights, origin=(-1.0, -1.0), resolution=0.02, variance=1e-6)
        self.assertEqual(robot.map_put(told), heights.size - 1)
        known = robot.map()
        self.assertEqual(known.heights.shape, heights.shape)
        self.assertAlmostEqual(known.height(0.7, 0.0), 0.1, places=3)
        self.assertAlmostEqual(known.height(0.2, 0.0), 0.0, places=3)
        self.assertTrue(np.isnan(known.height(9.0, 0.0)))
        coarse = robot.map(resolution=0.1)
        self.assertAlmostEqual(coarse.resolution, 0.1, places=6)
        robot.map_put(gaitd.HeightMap(np.full((50, 50), np.nan), origin=(-1.0, -1.0)), forget=True)
        self.assertIn("not known yet", robot.goto(-0.6, -0.6)["note"])
        robot.stop()
        robot.wait("standing", timeout=60)
        self.assertRegex(robot.goto(0.2, 0.1, 0.0)["note"], "footsteps, about")
        robot.wait("standing", timeout=60)
        with self.assertRaisesRegex(ValueError, "rows, columns"):
            robot.map_put(gaitd.HeightMap(np.zeros(3)))
        robot.map_clear()
        self.assertIsNone(robot.map())

    def test_a_hand_goes_where_it_is_sent_or_says_what_it_misses(self):
        self.assertIsNone(robot.pose("hand", "left", x=0.45, y=0.35, z=0.2, duration=1)["note"])
        away = robot.pose("hand", "left", frame="chest", x=2.0, y=0.3, z=0.3, duration=4)
        self.assertRegex(away["note"], "out of reach: the hand will miss by 1[.]")
        robot.pose("arm", "left", points=[{"time": 1.0, "joints": {"l_arm_elx": 1.0}}])
        with self.assertRaisesRegex(gaitd.Refused, "a joint of this arm"):
            robot.pose("arm", "left", joints={"r_arm_elx": 1.0})
        robot.pose("arm", "left")

    def test_waiting_ends_with_a_fault_or_the_time(self):
        with self.assertRaises(gaitd.WaitTimeout) as caught:
            robot.wait("walking", timeout=0.1)
        self.assertIsInstance(caught.exception, TimeoutError)
        robot.walk(20, length=0.3)
        robot.wait("walking")
        robot.estop()
        with self.assertRaises(gaitd.Fault) as caught:
            robot.wait("standing")
        self.assertEqual(caught.exception.faults, ["estop"])
        self.assertEqual(robot.wait(["fault", "disarmed"])["state"], "fault")

    def test_drives_until_it_lets_go(self):
        with robot.drive(forward=0.3) as drive:
            robot.wait("walking")
            drive.sleep(0.2)
            drive.set(forward=0.2, turn=0.1)
            target = robot.status()["drive"]["target"]
            self.assertEqual((target["forward"], target["turn"]), (0.2, 0.1))
        self.assertIsNone(robot.wait("standing")["drive"])
        drive.end()  # again

    def test_a_drive_that_is_taken_over_says_so(self):
        first = robot.drive(forward=0.2)
        with gaitd.connect(robot.socket) as another, another.drive(forward=0.1):
            with self.assertRaisesRegex(gaitd.Refused, "taken the robot over"):
                first.sleep(10)
        with self.assertRaises(gaitd.Refused):
            first.end()

    def test_parameters_and_layers(self):
        height = robot.get("gait.swing_height")
        answer = robot.set("gait.swing_height", height + 0.01)
        self.assertEqual((answer["old"], robot.get("gait.swing_height")), (height, height + 0.01))
        self.assertIn("gait.swing_height", [param["name"] for param in robot.params("gait.*")])
        robot.set("gait.swing_height", height)
        self.assertEqual(robot.swap("toe_off", "never")["variant"], "never")
        self.assertEqual(robot.rollback("toe_off")["variant"], "icp_criteria")
        self.assertEqual(robot.model().links[0], "pelvis")

    def test_a_push_moves_it(self):
        events = robot.events(timeout=0.3)
        taken = robot.push("utorso", (60.0, 0.0, 0.0), 0.1)
        told = [event for event in events if event.tick >= taken["tick"]]  # not the command before
        [pushed] = [event.text for event in told if event.kind == "command"]
        self.assertEqual((pushed["command"], pushed["force"], pushed["duration"]), ("sim.push", [60, 0, 0], 0.1))

    def test_each_thread_has_its_own(self):
        states = []

        def look():
            with gaitd.connect(robot.socket, role="observe") as mine:
                states.append(mine.status()["state"])

        threads = [threading.Thread(target=look) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(states, ["standing"] * 4)


class Connections(unittest.TestCase):
    def test_nobody_there(self):
        with self.assertRaises(gaitd.NoDaemon) as caught:
            gaitd.connect(scratch("nobody.sock"))
        self.assertIsInstance(caught.exception, ConnectionError)
        self.assertIn("nobody.sock: no such socket", str(caught.exception))

    def test_a_gaitd_that_does_not_start_says_why(self):
        with self.assertRaisesRegex(gaitd.ProgramError, "gait.swing_heigt"):
            gaitd.simulate(set={"gait.swing_heigt": 0.1})

    def test_the_end_of_gaitd_ends_its_clients_and_finishes_its_log(self):
        path = scratch("ends.mcap")
        with gaitd.simulate(log=path, clock="lockstep") as short:
            other = gaitd.connect(short.socket)
            self.addCleanup(other.close)
            events = short.events()
            folder = os.path.dirname(short.socket)
        with self.assertRaises(gaitd.NoDaemon):
            other.status()
        with self.assertRaises(gaitd.NoDaemon):
            list(events)
        self.assertFalse(os.path.exists(folder))
        self.assertGreater(gaitd.Log(path).ticks, 0)

    def test_a_gaitd_that_is_let_go_ends(self):
        short = gaitd.simulate(clock="lockstep")
        process = short._process
        del short
        gc.collect()
        process.wait(20)


if __name__ == "__main__":
    unittest.main()
