#!/usr/bin/env python3
"""roio-cli on real SocketCAN, with can-utils as its peers. Runs in scripts/lab: root, vcan0, vcan1."""

import glob
import io
import os
import random
import re
import signal
import subprocess
import time

from driver import CLI, GUARD, CliTest, catches, main, wait_until


def run(*command, stdin=None):
    done = subprocess.run(command, input=stdin, capture_output=True, text=True, timeout=GUARD)
    if done.returncode != 0:
        raise AssertionError(f"{command}: {done.returncode} {done.stderr}")
    return done.stdout


def receivers(interface):
    """How many filters of raw sockets the kernel has for an interface."""
    count = 0
    for name in glob.glob("/proc/net/can/rcvlist_*"):
        with open(name) as table:
            count += sum(line.split()[:1] == [interface] for line in table)
    return count


def is_asleep(process):
    with open(f"/proc/{process.pid}/stat") as stat:
        return stat.read().rsplit(")", 1)[1].split()[0] == "S"


def frames(log):
    """The frames of a log without their times and interfaces."""
    return [line.split()[2] for line in log.splitlines()]


class Peer:
    """A can-utils receiver that listens already. They do not say so; the kernel's tables do."""

    def __init__(self, *command, interface):
        before = receivers(interface)
        self.process = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True
        )
        wait_until(lambda: receivers(interface) > before)

    def output(self):
        try:
            return self.process.communicate(timeout=GUARD)[0]
        finally:
            self.process.kill()
            self.process.wait()


def mixed_traffic(interface, each):
    """Standard and extended, data and remote, lengths 0..8; gaps so that no receiver overruns."""
    for kind in ([], ["-e"], ["-R"], ["-e", "-R"]):
        run("cangen", interface, "-g", "1", "-n", str(each), "-L", "i", *kind)


class CandumpTest(CliTest):
    def logs_of_the_same_traffic(self, each=100):
        """What dump --log and candump -L wrote, byte for byte."""
        count = str(4 * each)
        candump = Peer("candump", "-L", "-n", count, "vcan0", interface="vcan0")
        dump = self.dump("--log", "-n", count, "vcan0")
        mixed_traffic("vcan0", each)
        ours, errors = dump.process.communicate(timeout=GUARD)
        self.assertEqual(dump.process.returncode, 0)
        self.assertEqual(errors, f"roio-cli: vcan0: {count} frames shown, 0 lost\n")
        return ours, candump.output()

    @staticmethod
    def kind(frame):
        identifier, data = frame.split("#")
        remote = data.startswith("R")
        return len(identifier), remote, int(data[1:] or 0) if remote else len(data) // 2

    def test_log_is_byte_for_byte_candumps(self):
        ours, theirs = self.logs_of_the_same_traffic()
        self.assertEqual(ours, theirs)  # the times too: both are the kernel's
        all_kinds = {(digits, remote, length)
                     for digits in (3, 8) for remote in (False, True) for length in range(9)}
        self.assertEqual({self.kind(frame) for frame in frames(ours)}, all_kinds)

    def test_filters_mean_what_candumps_mean(self):
        last = "7AB#0123456789ABCDEF"

        def lines_until_last(process):
            lines = []
            while not lines or not lines[-1].endswith(last + "\n"):
                lines.append(process.stdout.readline())
            return lines

        for word in ("100:700", "100~700", "00000000:80000001", "00000001:C0000001", "5:80000007"):
            with self.subTest(word):
                end = "7AB:C00007FF"
                candump = Peer("candump", "-L", f"vcan0,{word},{end}", interface="vcan0")
                dump = self.dump("--log", "vcan0", word, "or", end)
                mixed_traffic("vcan0", 50)
                run("cansend", "vcan0", last)
                ours = lines_until_last(dump.process)
                self.assertEqual(ours, lines_until_last(candump.process))
                self.assertGreater(len(ours), 1)
                candump.process.terminate()
                candump.output()

    def test_canplayer_plays_our_log(self):
        log, _ = self.logs_of_the_same_traffic(25)
        dump = self.dump("--log", "-n", "100", "vcan1")
        run("canplayer", "-t", "vcan1=vcan0", stdin=log)
        self.assertEqual(frames(dump.process.communicate(timeout=GUARD)[0]), frames(log))

    def test_log2asc_converts_our_log_and_we_read_it_back(self):
        dump = self.dump("--log", "-n", "50", "vcan0")
        run("cangen", "vcan0", "-g", "1", "-n", "25")
        run("cangen", "vcan0", "-g", "1", "-n", "25", "-e")
        log = dump.process.communicate(timeout=GUARD)[0]
        there_and_back = run("asc2log", stdin=run("log2asc", "vcan0", stdin=log))
        self.assertEqual(frames(there_and_back), frames(log))
        candump = Peer("candump", "-L", "-n", "50", "vcan1", interface="vcan1")
        self.send("vcan1", "-", stdin=there_and_back)
        self.assertEqual(frames(candump.output()), frames(log))

    def test_send_replays_candumps_log(self):
        _, log = self.logs_of_the_same_traffic(25)
        candump = Peer("candump", "-L", "-n", "100", "vcan1", interface="vcan1")
        self.send("vcan1", "-", stdin=log)
        self.assertEqual(frames(candump.output()), frames(log))

    def test_send_reads_direction_marks(self):
        candump = Peer("candump", "-L", "-n", "2", "vcan1", interface="vcan1")
        self.send("vcan1", "-", stdin="(1.000000) can0 123#11 R\n(1.000000) can0 124#22 T\n")
        self.assertEqual(frames(candump.output()), ["123#11", "124#22"])


    def test_send_replays_what_python_can_writes(self):
        import can  # only here: the lab's Python has it

        generator = random.Random(int(os.environ.get("ROIO_SEED", "13")))
        text = io.StringIO()
        writer = can.CanutilsLogWriter(text)
        sent = []
        for i in range(200):
            extended, remote = generator.random() < 0.5, generator.random() < 0.2
            data = bytes() if remote else generator.randbytes(generator.randrange(9))
            identifier = generator.randrange(1 << (29 if extended else 11))
            writer.on_message_received(can.Message(
                timestamp=i * 0.25 - 1, arbitration_id=identifier, is_extended_id=extended,
                is_remote_frame=remote, is_rx=generator.random() < 0.5, data=data, channel=0))
            body = "R" if remote else data.hex().upper()
            sent.append((f"{identifier:08X}#" if extended else f"{identifier:03X}#") + body)
        writer.on_message_received(can.Message(timestamp=100, is_error_frame=True, channel=0))
        candump = Peer("candump", "-L", "-n", "200", "vcan1", interface="vcan1")
        self.assertEqual(
            self.run_cli("send", "vcan1", "-", stdin=text.getvalue()),
            (0, "", "roio-cli: vcan1: 200 messages sent, passed over: 1 bus report\n"))
        self.assertEqual(frames(candump.output()), sent)


class CanFdTest(CliTest):
    """vcan0 as an interface with CAN FD."""

    def setUp(self):
        super().setUp()
        self.set_mtu(72)
        self.addCleanup(self.set_mtu, 16)

    @staticmethod
    def set_mtu(size):
        run("ip", "link", "set", "vcan0", "down")
        run("ip", "link", "set", "vcan0", "mtu", str(size), "up")

    def test_dump_tells_of_frames_that_it_cannot_show(self):
        dump = self.dump("-n", "1", "vcan0")
        run("cansend", "vcan0", "123##1112233")
        self.assertEqual(dump.line(), "! 1 CAN FD frame not shown\n")
        run("cansend", "vcan0", "123##0")
        run("cansend", "vcan0", "1000400A##0" + 64 * "FF")
        run("cansend", "vcan0", "1000400A#01")
        self.assertEqual(
            dump.result(),
            (0,
             "0.10   -> 0.2     normal  message  [1]  01\n"
             "! 2 CAN FD frames not shown\n",
             "roio-cli: vcan0: 1 frame shown, 0 lost, 3 CAN FD frames not shown\n"))

    def test_they_are_objects_in_json_and_leave_a_log_as_it_is(self):
        for option, output, errors in (
            ("--json", '{"type":"CAN FD","frames":1}\n', ""),
            ("--log", "", "roio-cli: vcan0: 1 CAN FD frame not shown\n"),
        ):
            dump = self.dump("-n", "1", option, "vcan0")
            run("cansend", "vcan0", "123##1112233")
            run("cansend", "vcan0", "1000400A#01")
            status, out, err = dump.result()
            self.assertEqual(status, 0)
            self.assertIn(output, out)
            self.assertEqual(len(out.splitlines()), 1 + len(output.splitlines()))
            self.assertEqual(err, errors + "roio-cli: vcan0: 1 frame shown, 0 lost, 1 CAN FD frame not shown\n")

    def test_filters_are_theirs_too_and_classic_frames_are_sent(self):
        dump = self.dump("-n", "1", "vcan0", "123:7FF")
        run("cansend", "vcan0", "124##0")
        run("cansend", "vcan0", "123##0")
        self.send("vcan0", "123#11")
        self.assertEqual(dump.result()[2],
                         "roio-cli: vcan0: 1 frame shown, 0 lost, 1 CAN FD frame not shown\n")


class MessageTest(CliTest):
    def test_what_cansend_sends_we_decode(self):
        dump = self.dump("-n", "4", "vcan0")
        for frame in ("1000400A#5A2D00", "041FE003#", "123#11.22", "1000400A#R4"):
            run("cansend", "vcan0", frame)
        self.assertEqual(
            dump.result(),
            (0,
             "0.10   -> 0.2     normal  message  [3]  5A 2D 00\n"
             "0.3    -> 0.*     urgent  system   [0]\n"
             "foreign  11-bit 123                [2]  11 22\n"
             "foreign  29-bit 1000400A           [4]  remote request\n",
             ""),
        )

    def test_what_we_send_candump_prints(self):
        candump = Peer("candump", "-L", "-n", "3", "vcan0", interface="vcan0")
        self.send("vcan0", "0.2", "5A2D00")
        self.send("--urgent", "--class", "system", "--from", "0.3", "vcan0", "0.*")
        self.send("vcan0", "31.254", "--dec", "1", "2", "3", "4", "5", "6", "7", "255")
        self.assertEqual(
            frames(candump.output()),
            ["1000400A#5A2D00", "041FE003#", "13FFC00A#01020304050607FF"],
        )

    def test_words_are_filters_in_the_kernel(self):
        dump = self.dump("-n", "1", "vcan0", "to=0.2", "urgent")
        with open("/proc/net/can/rcvlist_fil") as table:
            self.assertRegex(table.read(), r"(?m)^\s*vcan0\s+80004000\s+d3ffe000\s")
        run("cansend", "vcan0", "1000400A#01")
        run("cansend", "vcan0", "0000400A#02")
        self.assertEqual(dump.result()[1], "0.10   -> 0.2     urgent  message  [1]  02\n")


class TroubleTest(CliTest):
    def setUp(self):
        super().setUp()
        self.addCleanup(run, "ip", "link", "set", "vcan0", "up")

    def overrun(self, *form):
        """A dump that is stopped while more is sent than the kernel keeps for it: as for a user, who
        may not ask for a bigger buffer."""
        as_user = ["setpriv", "--bounding-set", "-net_admin"]
        dump = self.dump(*form, "vcan0", prefix=as_user)
        dump.signal(signal.SIGSTOP)
        self.send("--count", "5000", "vcan0", "0.2", "01")
        dump.signal(signal.SIGCONT)
        # It sleeps when it has read all there was: there is room for the frame that brings the news.
        wait_until(lambda: is_asleep(dump.process))
        self.send("vcan0", "0.2", "02")
        out = ""
        while not out.endswith("02\n"):
            line = dump.line()
            self.assertNotEqual(line, "", "the last frame never came")
            out += line
        dump.signal(signal.SIGINT)
        err = dump.process.communicate(timeout=GUARD)[1]
        self.assertEqual(dump.process.returncode, 128 + signal.SIGINT)
        return out, err

    def check_counts(self, err):
        shown, lost = map(int, re.search(r"vcan0: (\d+) frames shown, (\d+) lost\n$", err).groups())
        self.assertGreater(lost, 0)
        self.assertEqual(shown + lost, 5001)
        return shown, lost

    def test_lost_frames_are_announced_in_line(self):
        out, err = self.overrun()
        shown, lost = self.check_counts(err)
        lines = out.splitlines()
        self.assertEqual(lines.count("0.10   -> 0.2     normal  message  [1]  01"), shown - 1)
        announced = [line for line in lines if line.startswith("! ")]
        self.assertEqual(announced, [f"! {lost} frames lost"])
        self.assertEqual(lines[-2:], [announced[0], "0.10   -> 0.2     normal  message  [1]  02"])

    def test_lost_frames_leave_the_log_as_it_is(self):
        out, err = self.overrun("--log")
        shown, lost = self.check_counts(err)
        self.assertEqual(len(out.splitlines()), shown)
        self.assertEqual(set(frames(out)), {"1000400A#01", "1000400A#02"})
        self.assertIn(f"roio-cli: vcan0: {lost} frames lost\n", err)

    def test_down_and_up_again_are_announced(self):
        dump = self.dump("-n", "1", "vcan0")
        run("ip", "link", "set", "vcan0", "down")
        self.assertEqual(dump.line(), "! bus is down\n")
        run("ip", "link", "set", "vcan0", "up")
        self.assertEqual(dump.line(), "! bus is error-active\n")
        run("cansend", "vcan0", "1000400A#01")
        self.assertEqual(dump.result(), (0, "0.10   -> 0.2     normal  message  [1]  01\n", ""))

    def test_an_outage_too_short_to_see_is_announced_all_the_same(self):
        dump = self.dump("-n", "1", "vcan0")
        run("sh", "-c", "ip link set vcan0 down; ip link set vcan0 up")
        self.assertEqual(dump.line(), "! bus is down\n")
        self.assertEqual(dump.line(), "! bus is error-active\n")
        run("cansend", "vcan0", "1000400A#01")
        self.assertEqual(dump.result()[0], 0)

    def test_a_bus_that_is_down_from_the_start_says_so(self):
        run("ip", "link", "set", "vcan0", "down")
        dump = self.dump("-n", "1", "vcan0")
        self.assertEqual(dump.line(), "! bus is down\n")
        run("ip", "link", "set", "vcan0", "up")
        self.assertEqual(dump.line(), "! bus is error-active\n")

    def test_error_reports_are_decoded_into_states_and_shown_when_asked_for(self):
        dump = self.dump("-n", "1", "--errors", "vcan0")
        run("cansend", "vcan0", "20000040#0000000000000000")
        self.assertEqual(
            dump.result(),
            (0,
             "error    00000040                  [8]  00 00 00 00 00 00 00 00  bus-off\n"
             "! bus is bus-off\n",
             ""),
        )

    def test_bus_off_is_announced_without_asking_for_reports(self):
        dump = self.dump("vcan0")
        run("cansend", "vcan0", "20000040#0000000000000000")
        self.assertEqual(dump.line(), "! bus is bus-off\n")
        run("cansend", "vcan0", "20000100#0000000000000000")
        self.assertEqual(dump.line(), "! bus is error-active\n")

    def test_a_send_that_times_out_says_what_the_bus_is(self):
        run("ip", "link", "set", "vcan0", "down")
        self.assertEqual(
            self.run_cli("send", "--timeout", "100", "vcan0", "0.2", "01"),
            (1, "",
             "roio-cli: vcan0: not sent within 100 ms, the bus is down; 0 messages sent before\n"),
        )

    def test_a_send_waits_for_the_bus(self):
        run("ip", "link", "set", "vcan0", "down")
        sender = subprocess.Popen([CLI, "send", "--timeout", "30000", "vcan0", "0.2", "01"])
        time.sleep(0.3)
        self.assertIsNone(sender.poll())
        run("ip", "link", "set", "vcan0", "up")
        self.assertEqual(sender.wait(GUARD), 0)

    def test_a_signal_ends_a_send_that_waits(self):
        run("ip", "link", "set", "vcan0", "down")
        sender = subprocess.Popen(
            [CLI, "send", "--timeout", "30000", "vcan0", "0.2", "01"],
            stderr=subprocess.PIPE, text=True,
        )
        wait_until(lambda: catches(sender, signal.SIGINT))
        sender.send_signal(signal.SIGINT)
        # While the bus is still being opened, there is nothing to count yet.
        self.assertIn(sender.communicate(timeout=GUARD)[1], ("", "roio-cli: vcan0: 0 messages sent\n"))
        self.assertEqual(sender.returncode, 128 + signal.SIGINT)


class WrongBusTest(CliTest):
    def test_no_such_interface(self):
        self.assertEqual(
            self.run_cli("dump", "nosuch0"),
            (2, "",
             "roio-cli: nosuch0 (did you mean local:nosuch0?): no such network interface; `ip link` lists "
             "them, and local:NAME needs none\n"),
        )

    def test_not_a_can_interface(self):
        self.assertEqual(
            self.run_cli("send", "lo", "0.2"),
            (2, "",
             "roio-cli: lo: not a CAN interface; `ip link show type can` lists those, and "
             "local:NAME needs none\n"),
        )


if __name__ == "__main__":
    main()
