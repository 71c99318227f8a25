#!/usr/bin/env python3
"""roio-cli play on local buses: every frame of a log, in its order, when and where it should go."""

import os
import pty
import random
import re
import select
import signal
import subprocess
import time

from driver import CLI, GUARD, CliTest, catches, main, wait_until

BUS = "local:robot"


def frames(log):
    """The frames of a log without their times and interfaces."""
    return [line.split()[2] for line in log.splitlines()]


def sleeps(process):
    with open(f"/proc/{process.pid}/status") as status:
        return "State:\tS" in status.read()


class PlayTest(CliTest):
    def log(self, text, name="drive.log"):
        with open(self.path(name), "w") as file:
            file.write(text)
        return self.path(name)

    def play(self, *arguments, stdin=""):
        """Exit status and errors, the path of the log cut down to its name."""
        status, out, err = self.run_cli("play", *arguments, stdin=stdin)
        self.assertEqual(out, "")
        return status, err.replace(self.folder + "/", "")

    def played(self, text, *arguments, bus=BUS, count=None):
        """What a log becomes on a bus, as a log; what play said, and its exit status."""
        count = len(text.splitlines()) if count is None else count
        dump = self.dump("--log", "-n", str(count), bus)
        start = time.monotonic()
        status, err = self.play(*arguments, self.log(text), bus)
        self.took_ms = (time.monotonic() - start) * 1000
        return dump.process.communicate(timeout=GUARD)[0], status, err


class OrderTest(PlayTest):
    def test_frames_of_all_kinds_come_out_in_the_order_of_the_log(self):
        seed = int(os.environ.get("ROIO_SEED", "14"))
        print("seed", seed)
        generator = random.Random(seed)
        text = ""
        for number in range(3000):
            frame = generator.choice((
                f"{generator.randrange(1 << 11):03X}#", f"{generator.randrange(1 << 28):08X}#",
                f"{(1 << 28) + generator.randrange(1 << 28):08X}#"))
            data = generator.randbytes(generator.randrange(9)).hex().upper()
            if generator.random() < 0.1:
                data = f"R{generator.randrange(1, 9)}"
            text += f"(1000.{number // 100:06}) can0 {frame}{data}\n"
        log, status, err = self.played(text, "--speed", "max")
        self.assertEqual((status, err), (0, "roio-cli: drive.log: 3000 frames sent\n"))
        self.assertEqual(frames(log), frames(text))

    def test_a_log_of_several_buses_keeps_its_order_on_each(self):
        text = "".join(f"(1.0) can{number % 3} {number % 3}00#{number:04X}\n" for number in range(300))
        dumps = [self.dump("--log", "-n", "100", f"local:{name}") for name in "abc"]
        self.assertEqual(self.play(self.log(text), "local:a=can0", "local:b=can1", "local:c"),
                         (0, "roio-cli: drive.log: 300 frames sent\n"))
        for number, dump in enumerate(dumps):
            log = dump.process.communicate(timeout=GUARD)[0]
            self.assertEqual(frames(log), [f for f in frames(text) if f.startswith(f"{number}00")])

    def test_what_record_writes_comes_back(self):
        text = "".join(f"(1.0) x 1000400A#{number:04X}\n" for number in range(200))
        record = subprocess.Popen([CLI, "record", "-n", "200", "-o", self.path("first.log"), BUS],
                                  stderr=subprocess.PIPE, text=True)
        record.stderr.readline()
        self.send(BUS, "-", stdin=text)
        self.assertEqual(record.communicate(timeout=GUARD)[1].count(" 0 lost"), 1)
        with open(self.path("first.log")) as file:
            log, status, _ = self.played(file.read(), "--speed", "10")
        self.assertEqual((status, frames(log)), (0, frames(text)))

    def test_json_lines_are_played_too(self):
        dump = self.dump("--json", "-n", "3", BUS)
        self.send(BUS, "-", stdin="1000400A#01\n123#R2\n0000400A#02\n")
        lines = dump.process.communicate(timeout=GUARD)[0]
        log, status, err = self.played(lines)
        self.assertEqual((status, err), (0, "roio-cli: drive.log: 3 frames sent\n"))
        self.assertEqual(frames(log), ["1000400A#01", "123#R2", "0000400A#02"])

    def test_json_lines_of_several_buses_go_where_each_should(self):
        dump = self.dump("--json", "-n", "3", BUS, "local:desk")
        self.send(BUS, "-", stdin="1000400A#01\n123#11\n")
        self.send("local:desk", "0.2", "02")
        path = self.log(dump.process.communicate(timeout=GUARD)[0])
        dumps = [self.dump("--log", "-n", count, bus) for count, bus in (("2", "local:a"), ("1", "local:b"))]
        self.assertEqual(self.play(path, "local:a=local:robot", "local:b=local:desk"),
                         (0, "roio-cli: drive.log: 3 frames sent\n"))
        self.assertEqual([frames(dump.process.communicate(timeout=GUARD)[0]) for dump in dumps],
                         [["1000400A#01", "123#11"], ["1000400A#02"]])


class TimeTest(PlayTest):
    """Of a whole log: too long is the machine's affair; too short would be ours. What each frame is due at, the
    table of schedule_test.cpp has."""

    def test_it_takes_as_long_as_the_log(self):
        text = "(7.000000) x 001#\n(7.100000) x 002#\n(7.100000) x 003#\n(7.400000) x 004#\n"
        log, status, _ = self.played(text)
        self.assertEqual((status, frames(log)), (0, frames(text)))
        self.assertGreaterEqual(self.took_ms, 400)

    def test_slower(self):
        self.played("(7.00) x 001#\n(7.05) x 002#\n", "--speed", "0.2")
        self.assertGreaterEqual(self.took_ms, 250)

    def test_an_hour_is_not_waited_for_when_it_is_cut_or_made_short(self):
        text = "(0.0) x 001#\n(3600.0) x 002#\n(7200.0) x 003#\n"
        for options in (["--gap", "50"], ["--speed", "max"], ["--speed", "1000", "--gap", "0"]):
            with self.subTest(options):
                log, status, _ = self.played(text, *options)
                self.assertEqual((status, frames(log)), (0, frames(text)))
                if options[0] == "--gap":
                    self.assertGreaterEqual(self.took_ms, 100)

    def test_a_signal_ends_a_pause_of_hours(self):
        dump = self.dump("-n", "1", BUS)
        path = self.log("(0.0) x 001#\n(7200.0) x 002#\n")
        player = subprocess.Popen([CLI, "play", path, BUS], stderr=subprocess.PIPE, text=True)
        self.assertEqual(dump.result()[0], 0)
        player.send_signal(signal.SIGINT)
        self.assertEqual(player.communicate(timeout=GUARD)[1],
                         f"roio-cli: {path}: 1 frame sent\n")
        self.assertEqual(player.returncode, 130)

    def test_a_time_that_goes_back_is_told_and_the_rest_keeps_its_pace(self):
        text = "(5000.0) x 001#\n(1.0) x 002#\n(1.1) x 003#\n(5000.0) x 004#\n"
        log, status, err = self.played(text, "--gap", "100")
        self.assertEqual((status, err), (
            0, "roio-cli: drive.log: 4 frames sent, the log's time went back 1 time\n"))
        self.assertEqual(frames(log), frames(text))
        self.assertGreaterEqual(self.took_ms, 200)

    def test_times_that_cannot_be_read_follow_the_frame_before(self):
        text = "(-0.5) x 001#\n(7.0) x 002#\n(2015-07-10 08:17:32.2) x 003#\n004#\n(7.1) x 005#\n"
        dump = self.dump("--log", "-n", "5", BUS)
        self.assertEqual(self.play(self.log(text), BUS), (
            0, "roio-cli: drive.log: 5 frames sent, 3 without a time sent at once\n"))
        log = dump.process.communicate(timeout=GUARD)[0]
        self.assertEqual(frames(log), ["001#", "002#", "003#", "004#", "005#"])

    def test_from_and_to(self):
        text = "".join(f"({100 + number}.5) x {number:03X}#\n" for number in range(10))
        for options, sent in (
            (["--from", "104.5", "--to", "106.5"], ["004#", "005#", "006#"]),
            (["--from", "+4", "--to", "+6"], ["004#", "005#", "006#"]),
            (["--from", "108.500001"], ["009#"]),
            (["--to", "100.5"], ["000#"]),
        ):
            with self.subTest(options):
                log, status, _ = self.played(text, "--gap", "0", *options, count=len(sent))
                self.assertEqual((status, frames(log)), (0, sent))
        self.assertEqual(self.play("--from", "200", self.log(text), BUS), (
            1, "roio-cli: drive.log: 0 frames sent, all of it outside of --from and --to\n"))

    def test_the_end_is_the_end_though_more_would_come(self):
        """A pipe that is never closed."""
        player = subprocess.Popen([CLI, "play", "--to", "+1", "-", BUS], stdin=subprocess.PIPE,
                                  stderr=subprocess.PIPE, text=True)
        player.stdin.write("(1.0) x 001#\n(1.1) x 002#\n(3.1) x 003#\n")
        player.stdin.flush()
        self.assertEqual(player.wait(GUARD), 0)
        self.assertIn("standard input: 2 frames sent\n", player.stderr.read())
        player.communicate()

    def test_again_and_again(self):
        text = "(7.00) x 001#\n(7.05) x 002#\n"
        log, status, err = self.played(text, "--loop=3", count=6)
        self.assertEqual((status, err), (0, "roio-cli: drive.log: 6 frames sent\n"))
        self.assertEqual(frames(log), ["001#", "002#"] * 3)
        self.assertGreaterEqual(self.took_ms, 150)

    def test_for_ever_ends_by_a_signal(self):
        dump = self.dump("-n", "50", BUS)
        path = self.log("(7.000) x 001#\n(7.001) x 002#\nbroken\n")
        player = subprocess.Popen([CLI, "play", "--loop", path, BUS], stderr=subprocess.PIPE, text=True)
        self.assertEqual(dump.result()[0], 0)
        player.send_signal(signal.SIGTERM)
        err = player.communicate(timeout=GUARD)[1]
        self.assertEqual(player.returncode, 128 + signal.SIGTERM)
        self.assertEqual(err.count("broken") + err.count("expected a JSON message"), 1)  # once, not each time
        self.assertRegex(err, r"\d+ frames sent, 1 line refused\n$")

    def test_a_loop_of_nothing_ends(self):
        self.assertEqual(self.play("--loop", self.log("# nothing\n"), BUS), (
            1, "roio-cli: drive.log: 0 frames sent, passed over: 1 comment\n"))


class LineTest(PlayTest):
    def test_broken_lines_are_named_and_the_others_sent(self):
        text = ("(1.0) can0 123#11\n"
                "(1.0) can0 123#1\n"
                "\n"
                "# a comment\n"
                "(1.0) can0 20000004#0001000000000000\n"
                "(1.0) can0 123##1122\n"
                "(1.0) can0 124#11 R\r\n"
                "(1.0) can0 125#00112233445566")
        log, status, err = self.played(text, count=3)
        self.assertEqual(frames(log), ["123#11", "124#11", "125#00112233445566"])
        self.assertEqual((status, err), (
            1,
            'roio-cli: drive.log: line 2: log line "(1.0) can0 123#1": frame "123#1": odd number of hex '
            "digits; expected two per byte\n"
            'roio-cli: drive.log: line 6: log line "(1.0) can0 123##1122": frame "123##1122": a CAN FD '
            'frame ("##"); only classic CAN frames are taken\n'
            "roio-cli: drive.log: 3 frames sent, 2 lines refused, passed over: 1 bus report, 1 comment\n"))

    def test_a_log_that_a_kill_has_cut(self):
        log, status, err = self.played("(1.0) x 001#11\n(1.0) x 002#1", count=1)
        self.assertEqual((status, frames(log)), (1, ["001#11"]))
        self.assertIn("1 frame sent, 1 line refused\n", err)

    def test_what_has_nothing_to_send_is_a_failure(self):
        for name, text, said in (
            ("empty", "", "0 frames sent"),
            ("blank", "\n\n \n", "0 frames sent"),
            ("garbage", "".join(f"x{number}\n" for number in range(30)), "0 frames sent, 30 lines refused"),
        ):
            with self.subTest(name):
                status, err = self.play(self.log(text), BUS)
                self.assertEqual((status, err.splitlines()[-1]), (1, "roio-cli: drive.log: " + said))
                self.assertLessEqual(len(err.splitlines()), 12)

    def test_frames_of_other_interfaces_are_passed_over(self):
        dump = self.dump("--log", "-n", "1", BUS)
        text = "(1.0) can1 001#\n(1.0) can0 002#\n(1.0) can2 003#\n"
        self.assertEqual(self.play(self.log(text), BUS + "=can0"), (
            0, 'roio-cli: drive.log: 1 frame sent, 2 frames of other interfaces passed over, "can1" among '
               "them\n"))
        self.assertEqual(frames(dump.process.communicate(timeout=GUARD)[0]), ["002#"])

    def test_what_is_no_log(self):
        capture = self.path("drive.pcap")
        with open(capture, "wb") as file:
            file.write(b"\x4D\x3C\xB2\xA1" + bytes(20))
        self.assertEqual(self.play(capture, BUS), (
            1, "roio-cli: drive.pcap: a capture; expected a log, as record and candump -l write it\n"))
        self.assertEqual(self.play(self.path("none"), BUS),
                         (1, "roio-cli: none: No such file or directory\n"))
        self.assertEqual(self.play(self.folder, BUS)[0], 1)

    def test_a_signal_ends_the_wait_for_a_pipes_writer(self):
        os.mkfifo(self.path("pipe"))
        for number in (signal.SIGINT, signal.SIGTERM):
            player = subprocess.Popen([CLI, "play", self.path("pipe"), BUS], stderr=subprocess.PIPE, text=True)
            self.addCleanup(player.kill)
            wait_until(lambda: catches(player, number) and sleeps(player))
            player.send_signal(number)
            self.assertEqual(player.communicate(timeout=GUARD)[1], "")
            self.assertEqual(player.returncode, 128 + number)

    def test_a_line_is_sent_when_it_comes(self):
        dump = self.dump(BUS)
        player = subprocess.Popen([CLI, "play", "-", BUS], stdin=subprocess.PIPE, stderr=subprocess.PIPE,
                                  text=True)
        for number in range(3):
            player.stdin.write(f"(1.0) x 00{number}#\n")
            player.stdin.flush()
            self.assertIn(f"11-bit 00{number}", dump.line())
        player.send_signal(signal.SIGINT)  # while it waits for more
        self.assertIn("3 frames sent", player.communicate(timeout=GUARD)[1])
        self.assertEqual(player.returncode, 130)

    def test_a_large_log_takes_no_more_memory_than_a_small_one(self):
        most_kib = []
        for lines in (20000, 400000):
            # To nowhere, which is the faster way to have it read.
            player = subprocess.Popen([CLI, "play", "-", BUS + "=can1"], stdin=subprocess.PIPE,
                                      stderr=subprocess.PIPE, text=True)
            player.stdin.write("".join(f"(1.0) can0 1000400A#{number:016X}\n" for number in range(lines)))
            player.stdin.flush()  # all but what a pipe holds has been read
            with open(f"/proc/{player.pid}/status") as status:
                most_kib.append(int(re.search(r"VmHWM:\s*(\d+)", status.read())[1]))
            self.assertIn(f"{lines} frames of other interfaces", player.communicate(timeout=GUARD)[1])
        self.assertLess(most_kib[1], most_kib[0] + 4096, most_kib)


class BusTest(PlayTest):
    def test_nobody_there_is_told(self):
        self.assertEqual(self.play(self.log("(1.0) x 001#\n"), BUS), (
            0, "roio-cli: local:robot: nobody else was there to have 1 message\n"
               "roio-cli: drive.log: 1 frame sent\n"))

    def test_wait_is_until_somebody_listens_and_bounded(self):
        path = self.log("(1.0) x 001#\n")
        player = subprocess.Popen([CLI, "play", "--wait=600000", path, BUS], stderr=subprocess.PIPE,
                                  text=True)
        dump = self.dump("-n", "1", BUS)
        self.assertEqual(dump.result()[0], 0)
        self.assertEqual(player.communicate(timeout=GUARD)[1], f"roio-cli: {path}: 1 frame sent\n")
        self.assertEqual(self.play("--wait=20", path, BUS), (
            1, "roio-cli: local:robot: nobody came to listen within 20 ms; nothing was sent\n"))

    def test_a_bus_that_does_not_take_all_leaves_out_neither_the_others_nor_the_last_word(self):
        hub = subprocess.Popen([CLI, "hub", "robot"], stderr=subprocess.PIPE, text=True)
        self.addCleanup(hub.communicate)
        self.addCleanup(hub.kill)
        hub.stderr.readline()
        dumps = [self.dump(BUS), self.dump("local:desk")]
        player = subprocess.Popen([CLI, "play", "-", BUS + "=can0", "local:desk=can1"], stdin=subprocess.PIPE,
                                  stderr=subprocess.PIPE, text=True)
        self.addCleanup(player.kill)
        player.stdin.write("(1.0) can0 001#\n(1.0) can1 001#\n")
        player.stdin.flush()
        for dump in dumps:
            self.assertIn("001", dump.line())
        hub.send_signal(signal.SIGSTOP)
        os.waitpid(hub.pid, os.WUNTRACED)  # it stands still
        err = player.communicate("(1.0) can0 002#\n(1.0) can1 003#\n", timeout=GUARD)[1].splitlines()
        self.assertIn("003", dumps[1].line())
        self.assertEqual(player.returncode, 1)
        self.assertRegex(err[0], "^roio-cli: local:robot: .*")
        self.assertEqual(err[1:], ["roio-cli: standard input: 4 frames sent"])

    def test_a_bus_slower_than_the_log_is_told_and_loses_nothing(self):
        # 1 s of a bus at 20 kbit/s, in a log of 1 ms: eight bytes take 131 bits or more.
        bus = "local:slow?bitrate=20000"
        text = "".join(f"(1.000{number:03}) x 1000400A#{number:016X}\n" for number in range(300))
        log, status, err = self.played(text, bus=bus)
        self.assertEqual((status, frames(log)), (0, frames(text)))
        self.assertRegex(err, r"^roio-cli: drive.log: 300 frames sent(, up to \d+ s late)?\n$")


class ProgressTest(PlayTest):
    def on_terminal(self, path):
        """A play, and what waits until its terminal has seen something."""
        main_end, terminal = pty.openpty()
        self.addCleanup(os.close, main_end)
        player = subprocess.Popen([CLI, "play", path, BUS], stderr=terminal)
        os.close(terminal)
        seen = ""

        def see(pattern):
            nonlocal seen
            while not re.search(pattern, seen):
                self.assertTrue(select.select([main_end], [], [], GUARD)[0])
                seen += os.read(main_end, 4096).decode()

        return player, see

    def test_on_a_terminal_a_line_says_how_far_it_is(self):
        path = self.log("(0.0) x 001#\n(7200.0) x 002#\n")
        player, see = self.on_terminal(path)
        see(rf"\r\x1b\[K{re.escape(path)}: 100 %, 0:00:\d\d, 1 frame, next in 1:59:\d\d")
        player.send_signal(signal.SIGINT)
        see(rf"\r\x1b\[Kroio-cli: {BUS}: nobody else was there to have 1 message\r\n"
            rf"roio-cli: {re.escape(path)}: 1 frame sent\r\n$")
        self.assertEqual(player.wait(GUARD), 130)

    def test_what_is_told_meanwhile_has_a_line_of_its_own(self):
        path = self.log("(0.0) x 001#\n(1.5) x 002#\nbroken\n")
        player, see = self.on_terminal(path)
        see(rf"100 %, 0:00:\d\d, 1 frame\r\x1b\[Kroio-cli: {re.escape(path)}: line 3: expected .*\r\n")
        see(r"2 frames sent, 1 line refused\r\n$")
        self.assertEqual(player.wait(GUARD), 1)


if __name__ == "__main__":
    main()
