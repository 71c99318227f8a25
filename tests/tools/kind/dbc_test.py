"""A robot's DBC, read by canmatrix: frames at random mean there what Robot::decode() says.

ROIO_SEED repeats a run. MAKE_FRAMES is the program that makes the frames, ROIO_CLI makes the DBC. To be run by the
Python that Debian's python3-canmatrix is for.
"""
import collections
import contextlib
import io
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import warnings

with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):  # it tells of formats that it cannot read
    warnings.simplefilter("ignore")
    import canmatrix
    import canmatrix.formats

GUARD = 100  # seconds
ROBOT = pathlib.Path(__file__).with_name("robot") / "robot.json"
FRAMES = 6000  # most of which are asked for on purpose wrongly, or have no signals


def run(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, timeout=GUARD, check=True)


def read_dbc(robot):
    """The matrix, its text, and what roio-cli told."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "robot.dbc"
        told = run(os.environ["ROIO_CLI"], "robot", "dbc", "-o", file, robot).stderr.decode()
        return canmatrix.formats.loadp_flat(str(file)), file.read_bytes().decode("iso-8859-1"), told


class Dbc(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.matrix, cls.text, cls.told = read_dbc(ROBOT)

    def frame(self, name):
        frame = self.matrix.frame_by_name(name)
        self.assertIsNotNone(frame, name)
        return frame

    def test_who_and_where(self):
        self.assertEqual([ecu.name for ecu in self.matrix.ecus], ["pc", "panel", "drive", "meter", "class_"])
        # normal, to 0.2, from 0.10
        frame = self.frame("pc_to_drive")
        self.assertEqual((frame.arbitration_id.id, frame.arbitration_id.extended), (0x1000400A, True))
        self.assertEqual((frame.transmitters, frame.size), (["pc"], 6))
        self.assertEqual(frame.signal_by_name("speed_left").receivers, ["drive"])
        everybody = self.frame("pc_to_all_0")
        self.assertEqual(everybody.arbitration_id.id, 0x101FE00A)
        self.assertTrue(self.text.startswith("VERSION \"Made by `roio-cli robot dbc` from robot.json: "))

    def test_each_sender_has_what_its_kind_says_or_its_receivers_hear(self):
        self.assertEqual(collections.Counter(name.split("_to_")[0] for name in (f.name for f in self.matrix.frames)),
                         {"pc": 5, "panel": 5, "drive": 7, "meter": 7, "class_": 7})

    def test_signals(self):
        left = self.frame("pc_to_drive").signal_by_name("speed_left")
        self.assertEqual((float(left.factor), left.is_signed, left.is_little_endian, left.unit), (0.5, True, False, "mm/s"))
        right = self.frame("pc_to_drive").signal_by_name("speed_right")
        self.assertEqual((float(right.min), float(right.max)), (-1000, 1000))
        far = self.frame("pc_to_drive").signal_by_name("mode_far")
        self.assertEqual((far.unit, float(far.factor), float(far.max)), ("\u00b0", 5, 635))
        self.assertEqual(self.frame("pc_to_drive").signal_by_name("mode_state").values, {0: "off", 1: "on", 3: "3"})

    def test_long_names_are_cut_and_differ(self):
        names = [signal.name for signal in self.frame("meter_to_pc").signals]
        self.assertEqual(names, ["tag", "a_very_long_name_of_a_message_a_", "a_very_long_name_of_a_message__2",
                                 "a_very_long_name_of_a_message_i8"])

    def test_what_cannot_be_told_apart_has_no_signals_and_is_told(self):
        self.assertEqual(self.frame("pc_to_meter").signals, [])
        untold = "without signals, as a DBC tells messages apart by their tag alone"
        self.assertIn(f"{untold}: short (1 byte), long (2 bytes)", self.frame("pc_to_meter").comment)
        lines = self.told.splitlines()
        self.assertIn(f"roio-cli: {ROBOT}: pc to meter: {untold}: short (1 byte), long (2 bytes)", lines)
        self.assertIn(f"roio-cli: {ROBOT}: characters that ISO 8859-1 does not have: 14; each is a ?", lines)
        # two without a kind, to two of them and to everybody with them
        self.assertEqual(len([line for line in lines if untold in line]), 8)

    def test_frames_mean_the_same(self):
        output = run(os.environ["MAKE_FRAMES"], ROBOT, FRAMES).stdout.decode().splitlines()
        sys.stdout.write(output[0] + "\n")
        compared = collections.Counter()
        for line in map(json.loads, output[1:]):
            with self.subTest(line):
                compared[self.compare(line)] += 1
        self.assertGreater(compared["values"], 100)
        self.assertGreater(compared["tag"], 100)

    def compare(self, line):
        """What there was to compare."""
        frame = self.matrix.frame_by_id(canmatrix.ArbitrationId(line["id"], extended=True))
        if "message" not in line or len(line["data"]) != 2 * line["length"]:
            return "nothing"  # no frame of the robot's; or shorter, which canmatrix does not take
        if frame is None:
            self.assertNotIn(line["source"], ["pc", "panel"], "only who has a kind sends what that does not say")
            return "nothing"
        if not frame.signals:
            return "nothing"
        prefix = re.sub("-", "_", line["message"]) + "_"
        own = [signal for signal in frame.signals if signal.name.startswith(prefix)]
        if not own and line["fields"]:
            self.assertNotIn(line["source"], ["pc", "panel"])
            return "nothing"
        data = bytes.fromhex(line["data"]).ljust(frame.size, b"\0")
        found = frame.decode(data)
        if not line["fields"]:
            return "nothing"
        if frame.is_multiplexed:
            self.assertEqual(found["tag"].raw_value, data[0])
        values = [(signal, found[signal.name]) for signal in own]
        wanted = [self.expanded(field) for field in line["fields"]]
        wanted = [value for values in wanted for value in values]
        self.assertEqual(len(values), len(wanted))
        for (signal, value), (number, choice) in zip(values, wanted):
            self.assertAlmostEqual(float(signal.raw2phys(value.raw_value)), number, delta=abs(number) * 1e-12)
            if choice is not None:
                self.assertEqual(value.named_value, choice)
        return "tag" if frame.is_multiplexed else "values"

    @staticmethod
    def expanded(field):
        """Number and choice, or the numbers of bytes."""
        if "bytes" in field:
            return [(byte, None) for byte in field["bytes"]]
        return [(field["value"], field.get("choice"))]


class Shipped(unittest.TestCase):
    def test_the_arm_robot(self):
        matrix, _, told = read_dbc(os.environ["ROIO_SOURCES"] + "/examples/arm-robot/robot.json")
        self.assertEqual(told, "")
        angles = matrix.frame_by_name("pc_to_arm").decode(bytes.fromhex("5A2D00"))
        self.assertEqual({name: value.raw_value for name, value in angles.items()},
                         {"angles_shoulder": 90, "angles_elbow": 45, "angles_hand": 0})


if __name__ == "__main__":
    unittest.main(verbosity=2)
