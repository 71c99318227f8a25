#!/usr/bin/env python3
"""roio-cli record on local buses: what is in the file, whatever ends it."""

import fcntl
import os
import pty
import re
import resource
import select
import signal
import struct
import subprocess
import termios
import threading

from driver import CLI, GUARD, CliTest, main, wait_until

BUS = "local:robot"
LOG_LINE = re.compile(r"\(\d{10}\.\d{6}\) robot 1000400A#([0-9A-F]{16})\n")


def read(path, mode="r"):
    with open(path, mode) as file:
        return file.read()


class RecordTest(CliTest):
    def record(self, *arguments, **options):
        """A record that listens and has its file; killed at the end if it still runs."""
        options = {"stdin": subprocess.DEVNULL, "stderr": subprocess.PIPE, "text": True,
                   "cwd": self.folder, **options}
        process = subprocess.Popen([CLI, "record", *arguments], **options)
        guard = threading.Timer(2 * GUARD, process.kill)
        guard.start()

        def end():
            guard.cancel()
            if process.poll() is None:
                process.kill()
            process.communicate()

        self.addCleanup(end)
        process.first = process.stderr.readline()
        self.assertRegex(process.first, r"^roio-cli: .*: recording to .*\n$")
        return process

    def ends(self, process):
        """Exit status and what it said since it began."""
        err = process.communicate(timeout=GUARD)[1]
        return process.returncode, err

    def numbered(self, count):
        """Sends messages that have their numbers in them."""
        lines = "".join(f"1000400A#{number:016X}\n" for number in range(count))
        self.send("local:robot", "-", stdin=lines)

    def numbers(self, path):
        """Of the frames in a log, of which each line is whole."""
        found = []
        for line in read(path).splitlines(keepends=True):
            match = LOG_LINE.fullmatch(line)
            self.assertIsNotNone(match, line)
            found.append(int(match[1], 16))
        return found


class FormTest(RecordTest):
    def test_a_log_is_what_dump_log_writes(self):
        dump = self.dump("--log", "-n", "4", BUS)
        record = self.record("-n", "4", "-o", "drive.log", BUS)
        self.assertEqual(record.first, "roio-cli: local:robot: recording to drive.log\n")
        self.send(BUS, "-", stdin="1000400A#5A2D00\n123#R4\n0000400A#\n1FFFFFFF#0102030405060708\n")
        self.assertEqual(self.ends(record),
                         (0, "roio-cli: drive.log: 4 frames recorded, 0 lost\n"))
        dumped, _ = dump.process.communicate(timeout=GUARD)
        self.assertEqual(read(self.path("drive.log")), dumped)  # the times, too
        self.assertEqual(len(dumped.splitlines()), 4)

    def test_two_buses_are_in_one_log_each_by_its_name(self):
        record = self.record("-n", "3", "-o", "drive.log", BUS, "local:arm", "to=0.any")
        self.assertEqual(record.first, "roio-cli: local:robot, local:arm: recording to drive.log\n")
        self.send(BUS, "0.2", "01")
        self.send("local:arm", "123#11")  # which the filter leaves out
        self.send("local:arm", "0.2", "02")
        self.send(BUS, "0.2", "03")
        self.assertEqual(self.ends(record),
                         (0,
                          "roio-cli: local:robot: 2 frames recorded, 0 lost\n"
                          "roio-cli: local:arm: 1 frame recorded, 0 lost\n"
                          "roio-cli: drive.log: 3 frames recorded, 0 lost\n"))
        lines = [line.split(" ", 1) for line in read(self.path("drive.log")).splitlines()]
        self.assertEqual([frame for _, frame in lines],
                         ["robot 1000400A#01", "arm 1000400A#02", "robot 1000400A#03"])
        self.assertEqual(sorted(lines), lines)  # by time

    def test_the_names_ending_chooses_the_form_unless_an_option_does(self):
        for options, name, begin in (([], "a.csv", b"time,bus,"), ([], "a.pcap", b"\x4D\x3C\xB2\xA1"),
                                     ([], "a.txt", b"("), ([], "pcap", b"("),
                                     (["--csv"], "b.pcap", b"time,bus,"),
                                     (["--pcap"], "b.csv", b"\x4D\x3C\xB2\xA1")):
            with self.subTest(name):
                record = self.record("-n", "1", *options, "-o", name, BUS)
                self.send(BUS, "0.2", "01")
                self.assertEqual(self.ends(record)[0], 0)
                self.assertEqual(read(self.path(name), "rb")[:len(begin)], begin)

    def test_csv(self):
        record = self.record("-n", "1", "-o", "a.csv", BUS)
        self.send(BUS, "0.2", "5A2D00")
        self.ends(record)
        names, line = read(self.path("a.csv")).splitlines()
        self.assertRegex(line, r"^\d{10}\.\d{6},local:robot,extended,0x1000400A,normal,message,0,10,0,2,3,"
                               r"90,45,0,,,,,$")
        self.assertEqual(names.count(","), line.count(","))


class CountTest(RecordTest):
    def test_every_frame_is_there_once_and_in_order(self):
        count = 20000
        record = self.record("-n", str(count), "-o", "drive.log", BUS)
        self.numbered(count)
        self.assertEqual(self.ends(record),
                         (0, f"roio-cli: drive.log: {count} frames recorded, 0 lost\n"))
        self.assertEqual(self.numbers(self.path("drive.log")), list(range(count)))

    def test_fewer_than_waited_for(self):
        record = self.record("-n", "2", "-T", "50", "-o", "drive.log", BUS)
        self.assertEqual(self.ends(record),
                         (1,
                          "roio-cli: drive.log: 0 frames recorded, 0 lost\n"
                          "roio-cli: local:robot: 0 of 2 frames came in time\n"))
        self.assertEqual(read(self.path("drive.log")), "")

    def test_a_frame_is_in_the_file_soon_though_no_other_comes(self):
        record = self.record("-o", "drive.log", BUS)
        for count in (1, 2, 3):
            self.numbered(1)
            wait_until(lambda: len(self.numbers(self.path("drive.log"))) == count)
        self.assertIsNone(record.poll())


class EndTest(RecordTest):
    def flood(self):
        sender = subprocess.Popen([CLI, "send", "--count", "0", BUS, "0.2", "0102030405060708"],
                                  stderr=subprocess.DEVNULL)

        def end():
            sender.kill()
            sender.wait()

        self.addCleanup(end)

    def has_grown(self, name, size):
        wait_until(lambda: os.path.getsize(self.path(name)) > size)

    def test_a_signal_ends_it_with_all_that_came(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            record = self.record("-o", f"{number}.log", BUS)
            self.numbered(50)
            record.send_signal(number)
            status, err = self.ends(record)
            frames = len(self.numbers(self.path(f"{number}.log")))
            text = f"{frames} frame{'' if frames == 1 else 's'}"
            self.assertEqual((status, err), (
                128 + number, f"roio-cli: {number}.log: {text} recorded, 0 lost\n"))

    def test_a_signal_leaves_out_nothing_that_has_come(self):
        """However much of it has not been taken yet, from one bus and from several."""
        count = 1500
        hub = subprocess.Popen([CLI, "hub", "robot"], stderr=subprocess.PIPE, text=True)
        self.addCleanup(hub.communicate)
        self.addCleanup(hub.kill)
        hub.stderr.readline()
        for buses in ([BUS], [BUS, "local:other"]):
            with self.subTest(buses):
                name = f"{len(buses)}.log"
                record = self.record("-o", name, *buses)
                record.send_signal(signal.SIGSTOP)
                dump = self.dump("-n", str(count), BUS)  # has each frame after the record
                self.numbered(count)
                self.assertEqual(dump.result()[0], 0)
                record.send_signal(signal.SIGINT)
                record.send_signal(signal.SIGCONT)
                status, err = self.ends(record)
                self.assertEqual(status, 130)
                self.assertIn(f"{name}: {count} frames recorded, 0 lost\n", err)
                self.assertEqual(self.numbers(self.path(name)), list(range(count)))

    def test_a_signal_in_a_flood_leaves_whole_lines_and_their_number(self):
        self.flood()
        record = self.record("-o", "drive.log", BUS)
        self.has_grown("drive.log", 200000)
        record.send_signal(signal.SIGINT)
        status, err = self.ends(record)
        frames = len(self.numbers(self.path("drive.log")))
        self.assertEqual((status, err), (
            130, f"roio-cli: drive.log: {frames} frames recorded, 0 lost\n"))

    def test_killed_in_a_flood_it_leaves_whole_lines(self):
        self.flood()
        for attempt in range(5):
            name = f"{attempt}.log"
            record = self.record("-o", name, BUS)
            self.has_grown(name, 50000)
            record.kill()
            record.wait(GUARD)
            lines = read(self.path(name)).splitlines(keepends=True)
            self.assertGreater(len(lines), 1000)
            self.assertTrue(all(LOG_LINE.fullmatch(line) for line in lines[:-1]))
            # The kernel may end a write that a kill has met, which `play` takes for one bad line.
            self.assertTrue(LOG_LINE.fullmatch(lines[-1]) or not lines[-1].endswith("\n"), lines[-1])


class FullDiskTest(RecordTest):
    def limited(self, *arguments, size=100000):
        """A record whose file may grow to this size, which is an error of the same kind."""
        record = self.record(*arguments, BUS)
        resource.prlimit(record.pid, resource.RLIMIT_FSIZE, (size, size))
        lines = "".join(f"1000400A#{number:016X}\n" for number in range(20000))
        self.assertEqual(self.run_cli("send", BUS, "-", stdin=lines)[0], 0)  # the last have no listener
        return record

    def test_the_file_has_whole_lines_and_the_error_says_how_many(self):
        record = self.limited("-o", "drive.log")
        status, err = self.ends(record)
        numbers = self.numbers(self.path("drive.log"))
        self.assertGreater(len(numbers), 500)
        self.assertEqual(numbers, list(range(len(numbers))))
        self.assertEqual((status, err), (
            1, f"roio-cli: drive.log: File too large; {len(numbers)} frames recorded before\n"))

    def test_a_capture_has_whole_records(self):
        record = self.limited("-o", "drive.pcap", size=200000)
        status, err = self.ends(record)
        packets, rest = divmod(os.path.getsize(self.path("drive.pcap")) - 24, 16 + 16)
        self.assertEqual(rest, 0)
        self.assertEqual((status, err), (
            1, f"roio-cli: drive.pcap: File too large; {packets} frames recorded before\n"))

    def test_a_device_that_is_full(self):
        record = self.record("-o", "/dev/full", BUS)
        self.send(BUS, "0.2", "01")
        self.assertEqual(self.ends(record), (
            1, "roio-cli: /dev/full: No space left on device; 0 frames recorded before\n"))

    def test_not_even_room_for_what_stands_first(self):
        done = subprocess.run([CLI, "record", "--pcap", "-o", "/dev/full", BUS], capture_output=True,
                              text=True, timeout=GUARD)
        self.assertEqual((done.returncode, done.stderr), (
            1, "roio-cli: /dev/full: No space left on device; 0 frames recorded before\n"))


class FileTest(RecordTest):
    def test_a_file_that_is_there_is_kept(self):
        with open(self.path("drive.log"), "w") as file:
            file.write("dear\n")
        path = self.path("drive.log")
        # On a bus that cannot be opened: the file is looked at first.
        for bus in (BUS, "nosuch0"):
            self.assertEqual(self.run_cli("record", "-o", path, bus), (
                1, "", f"roio-cli: {path}: is there already; expected another name, or --force to "
                       "overwrite it\n"))
        self.assertEqual(read(path), "dear\n")

    def test_force_overwrites_it_once_the_bus_is_open(self):
        with open(self.path("drive.log"), "w") as file:
            file.write("old\n" * 1000)
        path = self.path("drive.log")
        self.assertEqual(self.run_cli("record", "--force", "-o", path, "nosuch0")[0], 2)
        self.assertEqual(len(read(path)), 4000)
        record = self.record("--force", "-n", "1", "-o", path, BUS)
        self.numbered(1)
        self.assertEqual(self.ends(record)[0], 0)
        self.assertEqual(self.numbers(path), [0])

    def test_a_bus_that_cannot_be_opened_leaves_no_file(self):
        self.assertEqual(self.run_cli("record", "-o", self.path("new.log"), "nosuch0")[0], 2)
        self.assertFalse(os.path.exists(self.path("new.log")))

    def test_a_folder_that_is_not_there(self):
        path = self.path("no/drive.log")
        self.assertEqual(self.run_cli("record", "-o", path, BUS),
                         (1, "", f"roio-cli: {path}: No such file or directory\n"))

    def test_without_a_name_it_has_the_dates_and_each_another(self):
        names = []
        for options in ([], [], [], ["--csv"], ["--pcap"]):
            record = self.record(*options, "-T", "1", BUS)
            names.append(re.search(r"recording to (.*)\n", record.first)[1])
            self.assertEqual(self.ends(record)[0], 0)
        for name, ending in zip(names, ("log", "log", "log", "csv", "pcap")):
            self.assertRegex(name, rf"^roio-\d{{4}}-\d\d-\d\d_\d{{6}}(-\d)?\.{ending}$")
        self.assertEqual(sorted(set(names) | {"buses"}), sorted(os.listdir(self.folder)))
        self.assertEqual(len(set(names)), len(names))

    def test_a_pipe_has_what_stands_first_at_once(self):
        """As a Wireshark has that reads it."""
        os.mkfifo(self.path("pipe"))
        record = subprocess.Popen([CLI, "record", "--pcap", "-o", self.path("pipe"), BUS],
                                  stderr=subprocess.PIPE, text=True)
        self.addCleanup(record.kill)
        with open(self.path("pipe"), "rb", buffering=0) as pipe:
            self.assertTrue(select.select([pipe], [], [], GUARD)[0])
            self.assertEqual(pipe.read(100), struct.pack("<IHHQII", 0xA1B23C4D, 2, 4, 0, 65535, 227))
            self.send(BUS, "0.2", "01")
            self.assertTrue(select.select([pipe], [], [], GUARD)[0])
            self.assertEqual(pipe.read(100)[16:], b"\x90\0\x40\x0A\1\0\0\0\1")
        self.send(BUS, "0.2", "02")  # and nobody reads on
        self.assertEqual(self.ends(record), (
            128 + signal.SIGPIPE, f"roio-cli: local:robot: recording to {self.path('pipe')}\n"))

    def test_a_signal_ends_the_wait_for_a_pipes_reader(self):
        os.mkfifo(self.path("pipe"))
        record = subprocess.Popen([CLI, "record", "-o", self.path("pipe"), BUS],
                                  stderr=subprocess.PIPE, text=True)
        wait_until(lambda: BUS in self.run_cli("buses", env=dict(os.environ, ROIO_SERIAL_PORTS=""))[1])
        record.send_signal(signal.SIGINT)
        self.assertEqual(self.ends(record), (130, ""))


class ProgressTest(RecordTest):
    def test_on_a_terminal_a_line_says_how_it_goes_and_is_gone_at_the_end(self):
        main_end, terminal = pty.openpty()
        fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
        record = subprocess.Popen([CLI, "record", "-o", self.path("drive.log"), BUS], stderr=terminal)
        os.close(terminal)
        seen = ""

        def see(pattern):
            nonlocal seen
            while not re.search(pattern, seen):
                self.assertTrue(select.select([main_end], [], [], GUARD)[0])
                seen += os.read(main_end, 4096).decode()

        path = re.escape(self.path("drive.log"))
        see("recording to " + path)
        self.send(BUS, "0.2", "01")
        see(rf"\r\x1b\[K{path}: 0:00:\d\d, 1 frame, 0 lost")
        record.send_signal(signal.SIGINT)
        see(rf"\r\x1b\[Kroio-cli: {path}: 1 frame recorded, 0 lost\r\n$")
        self.assertEqual(record.wait(GUARD), 130)
        os.close(main_end)


if __name__ == "__main__":
    main()
