#!/usr/bin/env python3
"""`roio-cli gen` and `gen --check`: what is sent is what is counted, and what is wrong is told."""

import re
import signal
import subprocess

from driver import CLI, GUARD, main
from live_driver import LiveTest

BUS = "local:robot"


class GenTest(LiveTest):
    def check(self, *arguments, bus=BUS):
        check = self.running("gen", "--check", "-v", *arguments, bus)
        self.assertEqual(check.first, f"roio-cli: {bus.split('?')[0]}: listening\n")
        return check

    def gen(self, *arguments, bus=BUS):
        """A gen that must succeed: what it says at its end."""
        status, out, err = self.run_cli("gen", *arguments, bus)
        self.assertEqual((status, out), (0, ""), err)
        return err.splitlines()[-1]

    def replay(self, *lines):
        """Messages of generator 7 from 0.10, as they were recorded."""
        self.send(BUS, "-", stdin="".join(line + "\n" for line in lines))

    def recorded(self, count, *options):
        dump = self.dump("-n", str(count), "--log", BUS)
        self.gen("--count", str(count), "--id", "7", *options)
        out, _ = dump.process.communicate(timeout=GUARD)
        return [line.split()[2] for line in out.splitlines()]

    def test_every_length_arrives_whole(self):
        for size in ("4", "5", "6", "7", "8", "random", "4-6"):
            with self.subTest(size):
                check = self.check("--count", "5000")
                said = self.gen("--count", "5000", "--id", "7", "--size", size)
                self.assertRegex(said, r"^roio-cli: local:robot: 5000 messages sent as 0\.10 #7 in "
                                       r"\d+\.\d{3} s, \d+/s$")
                self.assertEqual(check.end(), (
                    0, "0.10 #7: 5000 received, from number 0, 0 lost, 0 doubled, 0 out of order\n", ""))

    def test_several_at_once_are_told_apart(self):
        check = self.check("--count", "9000")
        others = [subprocess.Popen([CLI, "gen", "--count", "3000", *words, BUS], stderr=subprocess.DEVNULL)
                  for words in (("--id", "1"), ("--id", "2"))]
        self.gen("--count", "3000", "--id", "1", "--from", "random", "--seed", "5", "--to", "random")
        for other in others:
            self.assertEqual(other.wait(GUARD), 0)
        what = ": 3000 received, from number 0, 0 lost, 0 doubled, 0 out of order\n"
        self.assertEqual(check.end(), (
            0, "any #1" + what + "0.10 #1" + what + "0.10 #2" + what +
            "all: 9000 received, 0 lost, 0 doubled, 0 out of order\n", ""))

    def test_what_is_lost_doubled_and_out_of_order_is_told_and_fails(self):
        messages = self.recorded(10)
        for what, sent, said in (
                ("lost", messages[:3] + messages[5:], "8 received, from number 0, 2 lost, 0 doubled, 0"),
                ("doubled", messages[:3] + messages[2:], "11 received, from number 0, 0 lost, 1 doubled, 0"),
                ("out of order", messages[:4] + messages[5:7] + messages[4:5] + messages[7:],
                 "10 received, from number 0, 0 lost, 0 doubled, 1")):
            with self.subTest(what):
                check = self.check("--count", str(len(sent)))
                self.replay(*sent)
                self.assertEqual(check.end(), (1, f"0.10 #7: {said} out of order\n", ""))

    def test_started_late_it_says_from_which_number_on(self):
        messages = self.recorded(10)
        check = self.check("--count", "4")
        self.replay(*messages[6:])
        self.assertEqual(check.end(), (
            0, "0.10 #7: 4 received, from number 6, 0 lost, 0 doubled, 0 out of order\n", ""))

    def test_other_messages_are_passed_over_and_counted(self):
        check = self.check("--count", "1")
        self.send(BUS, "0.2", "0102030405060708")
        self.send(BUS, "123#11")
        self.gen("--count", "1", "--id", "7")
        self.assertEqual(check.end(), (
            0, "0.10 #7: 1 received, from number 0, 0 lost, 0 doubled, 0 out of order\n",
            "roio-cli: local:robot: 1 other message passed over\n"))

    def test_too_few_and_none_fail(self):
        check = self.check("--count", "3", "-T", "200")
        self.gen("--count", "2", "--id", "7")
        status, out, err = check.end()
        self.assertEqual((status, err), (1, "roio-cli: local:robot: 2 of 3 messages came in time\n"))
        for end in ("-T", "--time"):
            self.assertEqual(self.run_cli("gen", "--check", end, "20", BUS),
                             (1, "", "roio-cli: local:robot: no numbered message came\n"))

    def test_signals_end_both_with_their_report(self):
        check = self.check()
        gen = subprocess.Popen([CLI, "gen", "--rate", "1000", "--id", "7", BUS], stderr=subprocess.PIPE,
                               text=True)
        listener = self.dump("-n", "50", BUS)
        self.assertEqual(listener.result()[0], 0)
        gen.send_signal(signal.SIGINT)
        _, err = gen.communicate(timeout=GUARD)
        self.assertEqual(gen.returncode, 128 + signal.SIGINT)
        sent = int(re.search(r"(\d+) messages sent as 0\.10 #7", err)[1])
        status, out, _ = check.end(signal.SIGTERM)
        self.assertEqual((status, out), (
            128 + signal.SIGTERM,
            f"0.10 #7: {sent} received, from number 0, 0 lost, 0 doubled, 0 out of order\n"))

    def test_a_seed_is_told_and_makes_the_same_again(self):
        def recorded(*options):
            dump = self.dump("-n", "20", "--log", BUS)
            _, _, err = self.run_cli("gen", "--count", "20", "--to", "random", "--size", "random",
                                     "--id", "3", *options, BUS)
            out, _ = dump.process.communicate(timeout=GUARD)
            return re.search(r"local:robot: seed (\d+)\n", err)[1], [line.split()[2] for line in out.splitlines()]

        seed, first = recorded()
        self.assertEqual(recorded("--seed", seed), (seed, first))
        self.assertNotEqual(recorded("--seed", str((int(seed) + 1) % 2**32))[1], first)

    def test_a_share_of_the_bus_is_what_is_asked_for(self):
        bus = "local:paced?bitrate=500000"
        check = self.check(bus=bus)
        said = self.gen("--load", "40%", "--time", "1000", bus=bus)
        share = float(re.search(r"load (\d+\.\d) %$", said)[1])
        # A busy machine may send less, never more.
        self.assertGreater(share, 1)
        self.assertLess(share, 41)
        status, out, _ = check.end(signal.SIGINT)
        self.assertIn(" 0 lost, 0 doubled, 0 out of order", out)

    def test_a_bus_that_goes_away_ends_it(self):
        check = self.check()
        gen = self.running("gen", "--timeout", "300", "--to", "random", "--seed", "1", BUS)
        check.process.send_signal(signal.SIGSTOP)
        status, out, err = gen.end()
        self.assertEqual((status, out), (1, ""))
        self.assertRegex(err, r"^roio-cli: local:robot: not sent within 300 ms, the bus is .*; \d+ messages? "
                              r"sent before\n$")


if __name__ == "__main__":
    main()
