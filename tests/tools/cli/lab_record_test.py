#!/usr/bin/env python3
"""roio-cli's record and play on real SocketCAN: can-utils and python-can read what it writes, and it plays what they
write. Runs in scripts/lab: root, vcan0, vcan1."""

import glob
import os
import random
import re
import signal
import subprocess

from driver import CLI, GUARD, CliTest, main, wait_until
from lab_can_utils_test import Peer, frames, is_asleep, mixed_traffic, run


class Record:
    """A record that listens already."""

    def __init__(self, *arguments, prefix=()):
        self.process = subprocess.Popen([*prefix, CLI, "record", *arguments], stdin=subprocess.DEVNULL,
                                        stderr=subprocess.PIPE, text=True)
        self.first = self.process.stderr.readline()
        if "recording to" not in self.first:
            raise AssertionError("record did not listen: " + self.first)

    def result(self):
        err = self.process.communicate(timeout=GUARD)[1]
        return self.process.returncode, err


def read(path):
    with open(path) as file:
        return file.read()


class PeersTest(CliTest):
    """One record of all kinds of frames, made beside candump."""

    def recorded(self, *options, name="drive.log", each=25):
        record = Record("-n", str(4 * each), *options, "-o", self.path(name), "vcan0")
        candump = Peer("candump", "-L", "-n", str(4 * each), "vcan0", interface="vcan0")
        mixed_traffic("vcan0", each)
        log = candump.output()
        self.assertEqual(record.result(), (
            0, f"roio-cli: {self.path(name)}: {4 * each} frames recorded, 0 lost\n"))
        return self.path(name), log

    def test_it_is_byte_for_byte_candumps(self):
        path, log = self.recorded()
        self.assertEqual(read(path), log)  # the times too: both are the kernel's

    def test_canplayer_plays_it(self):
        path, log = self.recorded()
        candump = Peer("candump", "-L", "-n", "100", "vcan1", interface="vcan1")
        run("canplayer", "-I", path, "vcan1=vcan0")
        self.assertEqual(frames(candump.output()), frames(log))

    def test_log2asc_converts_it_and_play_plays_what_comes_back(self):
        path, log = self.recorded()
        data = [line for line in log.splitlines(keepends=True) if "#R" not in line]
        with open(path, "w") as file:
            file.writelines(data)  # asc2log of Debian 12 leaves remote requests out
        ascii_log = run("log2asc", "-I", path, "vcan0")
        with open(self.path("back.log"), "w") as file:
            file.write(run("asc2log", stdin=ascii_log))
        candump = Peer("candump", "-L", "-n", str(len(data)), "vcan1", interface="vcan1")
        self.assertEqual(self.run_cli("play", "--speed", "max", self.path("back.log"), "vcan1")[0], 0)
        self.assertEqual(frames(candump.output()), frames("".join(data)))

    def test_python_can_reads_it(self):
        import can  # only here: the lab's Python has it

        path, log = self.recorded()
        found = []
        for message in can.CanutilsLogReader(path):
            identifier = f"{message.arbitration_id:0{8 if message.is_extended_id else 3}X}"
            # It takes no notice of the length that a remote request asks for.
            body = "R" if message.is_remote_frame else bytes(message.data).hex().upper()
            found.append(f"({message.timestamp:017.6f}) {message.channel} {identifier}#{body}")
        self.assertEqual(found, re.sub(r"#R\d?", "#R", log).splitlines())


class PlayTest(CliTest):
    def check(self, path, sent, *words):
        candump = Peer("candump", "-L", "-n", str(len(sent)), "vcan1", interface="vcan1")
        status, _, err = self.run_cli("play", "--speed", "10", path, *words)
        self.assertEqual((status, err), (0, f"roio-cli: {path}: {len(sent)} frames sent\n"))
        self.assertEqual(frames(candump.output()), sent)

    def test_what_candump_keeps(self):
        candump = Peer("sh", "-c", 'cd "$0" && exec candump -l -n 100 vcan0', self.folder, interface="vcan0")
        mixed_traffic("vcan0", 25)
        candump.output()
        path = glob.glob(self.path("candump-*.log"))[0]
        sent = frames(read(path))
        self.assertEqual(len(sent), 100)
        self.check(path, sent, "vcan1=vcan0")
        self.check(path, sent, "vcan1")

    def test_what_python_can_writes(self):
        import can

        generator = random.Random(int(os.environ.get("ROIO_SEED", "14")))
        path, sent = self.path("python.log"), []
        with open(path, "w") as file:
            writer = can.CanutilsLogWriter(file)
            for i in range(200):
                extended, remote = generator.random() < 0.5, generator.random() < 0.2
                data = bytes() if remote else generator.randbytes(generator.randrange(9))
                identifier = generator.randrange(1 << (29 if extended else 11))
                writer.on_message_received(can.Message(
                    timestamp=i * 0.005, arbitration_id=identifier, is_extended_id=extended,
                    is_remote_frame=remote, is_rx=generator.random() < 0.5, data=data, channel="vcan0"))
                body = "R" if remote else data.hex().upper()
                sent.append((f"{identifier:08X}#" if extended else f"{identifier:03X}#") + body)
        self.check(path, sent, "vcan1=vcan0")

    def test_two_interfaces_at_once_change_places(self):
        text = "".join(f"(1.000{number:03}) vcan{number % 2} {number:03X}#{number:02X}\n"
                       for number in range(100))
        with open(self.path("drive.log"), "w") as file:
            file.write(text)
        record = Record("-n", "100", "-o", self.path("back.log"), "vcan0", "vcan1")
        self.assertEqual(self.run_cli("play", self.path("drive.log"), "vcan0=vcan1", "vcan1=vcan0")[0], 0)
        self.assertEqual(record.result()[0], 0)
        back = [line.split() for line in read(self.path("back.log")).splitlines()]
        self.assertEqual([line[0] for line in back], sorted(line[0] for line in back))
        for name, other in (("vcan0", "vcan1"), ("vcan1", "vcan0")):
            self.assertEqual([line[2] for line in back if line[1] == name],
                             [line.split()[2] for line in text.splitlines() if line.split()[1] == other])

    def test_a_bus_that_is_down_ends_it_with_what_was_sent(self):
        run("ip", "link", "set", "vcan1", "down")
        self.addCleanup(run, "ip", "link", "set", "vcan1", "up")
        with open(self.path("drive.log"), "w") as file:
            file.write("(1.0) can0 123#\n")
        self.assertEqual(
            self.run_cli("play", "--timeout", "100", self.path("drive.log"), "vcan1"),
            (1, "",
             "roio-cli: vcan1: not sent within 100 ms, the bus is down; 0 messages sent before\n"))


class TroubleTest(CliTest):
    def test_lost_frames_are_told_and_leave_the_log_as_it_is(self):
        """As for a user, who may not ask for a bigger buffer, and a record that is stopped meanwhile."""
        for name in ("drive.log", "drive.csv", "drive.pcap"):
            with self.subTest(name):
                path = self.path(name)
                record = Record("-o", path, "vcan0", prefix=("setpriv", "--bounding-set", "-net_admin"))
                record.process.send_signal(signal.SIGSTOP)
                self.send("--count", "5000", "vcan0", "0.2", "01")
                record.process.send_signal(signal.SIGCONT)
                wait_until(lambda: os.path.getsize(path) > 1000 and is_asleep(record.process))
                self.send("vcan0", "0.2", "02")
                self.assertRegex(record.process.stderr.readline(), r"^roio-cli: vcan0: \d+ frames? lost\n$")
                record.process.send_signal(signal.SIGINT)
                status, err = record.result()
                self.assertEqual(status, 130)
                kept, lost = map(int, re.search(r": (\d+) frames recorded, (\d+) lost\n$", err).groups())
                self.assertEqual(kept + lost, 5001)
                self.assertGreater(lost, 0)
                if name == "drive.pcap":
                    self.assertEqual((os.path.getsize(path) - 24) / (16 + 9), kept)
                else:
                    self.assertEqual(len(read(path).splitlines()), kept + (name == "drive.csv"))

    def test_a_bus_that_goes_down_and_comes_back_is_told(self):
        self.addCleanup(run, "ip", "link", "set", "vcan0", "up")
        record = Record("-n", "1", "-o", self.path("drive.log"), "vcan0")
        run("ip", "link", "set", "vcan0", "down")
        self.assertEqual(record.process.stderr.readline(), "roio-cli: vcan0: bus is down\n")
        run("ip", "link", "set", "vcan0", "up")
        self.assertEqual(record.process.stderr.readline(), "roio-cli: vcan0: bus is error-active\n")
        run("cansend", "vcan0", "123#")
        self.assertEqual(record.result()[0], 0)
        self.assertEqual(frames(read(self.path("drive.log"))), ["123#"])


class SeveralTest(CliTest):
    def test_dump_shows_two_interfaces_with_a_column_for_them(self):
        dump = self.dump("-n", "3", "vcan0", "vcan1", "to=0.2", "or", "123:7FF")
        for interface, frame in (("vcan0", "1000400A#01"), ("vcan1", "123#11"), ("vcan1", "124#"),
                                 ("vcan0", "0000400A#02")):
            run("cansend", interface, frame)
        self.assertEqual(dump.first, "roio-cli: vcan0, vcan1: listening\n")
        self.assertEqual(dump.result(), (
            0,
            "vcan0 0.10   -> 0.2     normal  message  [1]  01\n"
            "vcan1 foreign  11-bit 123                [1]  11\n"
            "vcan0 0.10   -> 0.2     urgent  message  [1]  02\n", ""))

    def test_what_happens_to_one_is_told_of_that_one(self):
        self.addCleanup(run, "ip", "link", "set", "vcan1", "up")
        dump = self.dump("vcan0", "vcan1")
        run("ip", "link", "set", "vcan1", "down")
        self.assertEqual(dump.line(), "! vcan1: bus is down\n")
        run("cansend", "vcan0", "123#")
        self.assertEqual(dump.line(), "vcan0 foreign  11-bit 123                [0]\n")
        run("ip", "link", "set", "vcan1", "up")
        self.assertEqual(dump.line(), "! vcan1: bus is error-active\n")

    def test_time_with_date_is_candumps(self):
        candump = Peer("candump", "-t", "A", "-n", "5", "vcan0", interface="vcan0")
        dump = self.dump("-t", "A", "-n", "5", "vcan0")
        run("cangen", "vcan0", "-g", "1", "-n", "5")
        ours, _ = dump.process.communicate(timeout=GUARD)
        theirs = candump.output()
        date = re.compile(r"\(\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\.\d{6}\)")
        self.assertEqual(date.findall(ours), date.findall(theirs))
        self.assertEqual(len(date.findall(ours)), 5)


if __name__ == "__main__":
    main()
