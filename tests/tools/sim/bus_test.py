#!/usr/bin/env python3
"""Boards and the programs on a local bus."""

import signal
import subprocess

from sim_driver import GUARD, SIM, UNO, SimTest, main

BOTH = ("--do", "b hold 4", "--do", "wait 0.02", "--do", "b release 4", "a:uno=" + UNO, "b:uno=" + UNO)
RUNNING = ("a: can: normal, 500000 bit/s", "b: can: normal, 500000 bit/s")


class BusTest(SimTest):
    def boards(self, *arguments):
        sim = self.sim("--bus", "local:robot", *arguments)
        self.assertEqual(sim.first, "roio-sim: local:robot: joined\n")
        sim.wait_for(*[line for line in RUNNING if line[0] + ":uno=" + UNO in arguments])
        return sim

    def test_boards_are_seen_and_spoken_to(self):
        sim = self.boards(*BOTH)
        dump = self.dump("-n", "6", "local:robot")
        sim.say("a serial ping")
        self.assertEqual(dump.line(), "0.2    -> 0.3     normal  message  [1]  70\n")
        self.assertEqual(dump.line(), "0.3    -> 0.2     normal  message  [1]  50\n")
        sim.say("b press 4")
        self.assertEqual(dump.line(), "0.3    -> 0.10    normal  message  [2]  63 01\n")
        sim.say("a analog A0 2.5V")
        self.send("local:robot", "0.2", "61")
        self.assertEqual(dump.line(), "0.10   -> 0.2     normal  message  [1]  61\n")
        # 2.5 of 5 V, of 1024
        self.assertEqual(dump.line(), "0.2    -> 0.10    normal  message  [3]  41 02 00\n")
        self.send("local:robot", "0.3", "6F01")
        sim.wait_for("b: serial: 8008600A 02 6F01", "b: output: pin 7 high")
        self.send("local:robot", "0.2", "7605DC")
        sim.wait_for("a: servo: pin 9 at 93 degrees")  # 1500 us
        sim.say("quit")
        status, out, err = sim.result()
        self.assertEqual((status, err), (0, ""))
        self.assertEqual(out.splitlines()[-1], "bus: 3 frames from local:robot, 4 to it, 0 lost")
        self.assertEqual(dump.result()[0], 0)

    def test_all_kinds_of_frames_pass(self):
        sim = self.boards("a:uno=" + UNO)
        dump = self.dump("-n", "4", "local:robot")
        self.assertEqual(
            self.run_cli("send", "local:robot", "-", stdin="(0.0) can0 123#1122\n"),
            (0, "", ""))
        sim.wait_for("a: serial: 24600000 02 1122")
        # SRR or RTR, as the chip shows a remote request
        self.assertEqual(self.run_cli("send", "local:robot", "-", stdin="(0.0) can0 124#R\n")[0], 0)
        sim.wait_for("a: serial: 24900000 00 ")
        self.assertEqual(self.run_cli("send", "local:robot", "-", stdin="(0.0) can0 1000400A#R\n")[0], 0)
        sim.wait_for("a: serial: 8008400A 40 ")
        self.send("local:robot", "0.2", "70")
        self.assertEqual(
            dump.result(),
            (0,
             "foreign  11-bit 123                [2]  11 22\n"
             "foreign  11-bit 124                [0]  remote request\n"
             "foreign  29-bit 1000400A           [0]  remote request\n"
             "0.10   -> 0.2     normal  message  [1]  70\n", ""))

    def test_a_flood_arrives_whole_and_in_order(self):
        sim = self.boards("a:uno=" + UNO)
        dump = self.dump("-n", "1", "local:robot", "from=0.2")
        count = 5000
        # The bus has the simulated one's bit rate, and may be named with it.
        self.send("local:robot?bitrate=500000", "-", stdin="".join(
            f"(0.0) can0 1000400A#66{i:04X}{int(i == count - 1):02X}\n" for i in range(count)))
        # 5000 counted, 0 out of turn
        self.assertEqual(dump.result(), (0, "0.2    -> 0.10    normal  message  [5]  46 13 88 00 00\n",
                                         ""))
        sim.signal()
        status, out, err = sim.result()
        self.assertEqual((status, err), (130, ""))
        self.assertEqual(out.splitlines()[-1], "bus: 5000 frames from local:robot, 1 to it, 0 lost")

    def test_a_bus_that_was_there_before(self):
        dump = self.dump("-n", "1", "local:robot")
        status, out, err = self.run_sim("--bus", "local:robot", "--for", "0.3", "--do", "wait 0.1",
                                        "--do", "a press 4", "a:uno=" + UNO)
        self.assertEqual(
            (status, err),
            (0, "roio-sim: local:robot: was there before, and not at 500000 bit/s: it does not slow "
                "down who sends more than the simulated bus carries\n"))
        self.assertEqual(dump.result(),
                         (0, "0.2    -> 0.10    normal  message  [2]  63 01\n", ""))

    def test_half_the_speed_is_half_the_bit_rate(self):
        sim = self.sim("--bus", "local:robot", "--speed", "0.5", "a:uno=" + UNO)
        self.assertEqual(self.run_cli("send", "local:robot?bitrate=250000", "0.2", "01"), (0, "", ""))
        sim.signal()
        self.assertEqual(sim.result()[0], 130)

    def test_a_board_that_halts_is_a_failure(self):
        sim = self.boards("a:uno=" + UNO)
        self.send("local:robot", "0.2", "68")
        status, out, err = sim.result()
        self.assertEqual(status, 1)
        self.assertRegex(err, r"^roio-sim: a [^\n]*\n$")
        self.assertEqual(out.splitlines()[-1], "bus: 1 frame from local:robot, 0 to it, 0 lost")


class SignalTest(SimTest):
    def test_signals_end_it_cleanly_and_the_bus_goes_on(self):
        for number, expected in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            with self.subTest(expected):
                sim = self.sim("--bus", f"local:end{expected}", "a:uno=" + UNO)
                dump = self.dump("-n", "1", f"local:end{expected}")
                sim.wait_for(RUNNING[0])
                sim.signal(number)
                status, out, err = sim.result()
                self.assertEqual((status, err), (expected, ""))
                self.assertRegex(out, r"(?m)^bus: [\d.]+ s simulated, 0 frames, load 0\.0 %, 0 errors$")
                self.send(f"local:end{expected}", "0.2", "01")
                self.assertEqual(dump.result()[0], 0)

    def test_a_reader_that_goes_ends_it(self):
        done = subprocess.run(
            ["bash", "-c", '"$@" 2>&1 | head -n 1; echo "${PIPESTATUS[0]}"', "bash", SIM, "--do",
             "wait 0.2", "--do", "a serial hello", "a:uno=" + UNO],
            stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=GUARD)
        self.assertEqual(done.stdout, "a: serial: node 2\n141\n")


if __name__ == "__main__":
    main()
