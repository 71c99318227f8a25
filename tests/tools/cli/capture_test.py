#!/usr/bin/env python3
"""Captures that roio-cli writes, read by tshark: from a file, and from a pipe while it lasts."""

import re
import signal
import subprocess

from driver import CLI, GUARD, CliTest, main

BUS = "local:robot"
# All kinds and lengths. (Of the identifier 0, tshark takes the data for a message of something else.)
FRAMES = [f"{identifier}#{data}" for identifier in ("123", "7FF", "00000001", "1000400A", "1FFFFFFF")
          for data in ["R"] + [f"R{length}" for length in range(1, 9)] +
          ["0123456789ABCDEF"[:2 * length] for length in range(9)]]
FIELDS = ("frame.time_epoch", "can.id", "can.flags.xtd", "can.flags.rtr", "can.len", "data")


def tshark(*arguments, **options):
    words = [word for field in FIELDS for word in ("-e", field)]
    return subprocess.Popen(["tshark", "-n", "-l", "-T", "fields", *words, *arguments],
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)


class CaptureTest(CliTest):
    def as_log(self, shown):
        """What tshark shows of a capture, as a log."""
        lines = []
        for line in shown.splitlines():
            time, identifier, extended, remote, length, data = line.split("\t")
            body = data.upper()
            if remote == "1":
                body = "R" + (length if length != "0" else "")
            # Nanoseconds are there; a log has microseconds.
            self.assertRegex(time, r"^\d{10}\.\d{9}$")
            lines.append(f"({time[:-3]}) robot {int(identifier):0{8 if extended == '1' else 3}X}#{body}\n")
        return "".join(lines)

    def traffic(self):
        """Beside it, what a dump --log makes of it."""
        dump = self.dump("--log", "-n", str(len(FRAMES)), BUS)
        self.send(BUS, "-", stdin="\n".join(FRAMES))
        return dump.process.communicate(timeout=GUARD)[0]

    def test_a_file(self):
        path = self.path("drive.pcap")
        record = subprocess.Popen([CLI, "record", "-n", str(len(FRAMES)), "-o", path, BUS],
                                  stderr=subprocess.PIPE, text=True)
        record.stderr.readline()
        log = self.traffic()
        self.assertEqual(record.communicate(timeout=GUARD)[1],
                         f"roio-cli: {path}: {len(FRAMES)} frames recorded, 0 lost\n")
        shown, errors = tshark("-r", path).communicate(timeout=GUARD)
        self.assertEqual(self.as_log(shown), log, errors)
        self.assertEqual([line.split()[2] for line in log.splitlines()], FRAMES)
        verbose = subprocess.run(["tshark", "-n", "-r", path, "-V"], capture_output=True, text=True,
                                 timeout=GUARD).stdout
        self.assertEqual(re.findall(r"(?i)malformed|exception|truncated", verbose), [])
        self.assertEqual(verbose.count("Encapsulation type: SocketCAN"), len(FRAMES))

    def test_a_pipe_while_it_lasts(self):
        """As the one of a Wireshark that is on: what it has read, it shows, though the pipe goes on."""
        dump = self.dump("--pcap", BUS)
        reader = tshark("-i", "-", "-c", str(len(FRAMES)), stdin=dump.process.stdout)
        # It says so once it has read what stands first.
        self.assertTrue(any("Capturing on" in line for line in reader.stderr))
        log = self.traffic()
        shown = reader.communicate(timeout=GUARD)[0]
        self.assertEqual(self.as_log(shown), log)
        dump.signal(signal.SIGINT)


if __name__ == "__main__":
    main()
