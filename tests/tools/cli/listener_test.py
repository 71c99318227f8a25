#!/usr/bin/env python3
"""roio-cli and who is on the bus: nobody, somebody later, and a bus that does not open."""

import os
import pty
import select
import signal
import subprocess
import time

from driver import CLI, GUARD, CliTest, catches, main, wait_until

BUS = "local:robot"


class OpeningTest(CliTest):
    """A signal while a bus is being opened: 5 s are what opening may take, and then it fails with 1."""

    def ends(self, *arguments, opening):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(arguments, number=number):
                process = subprocess.Popen([CLI, *arguments], stdin=subprocess.DEVNULL,
                                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                opening(process)
                process.send_signal(number)
                self.assertEqual(process.communicate(timeout=GUARD), ("", ""))
                self.assertEqual(process.returncode, 128 + number)

    def test_a_board_that_does_not_answer(self):
        for before, after in ((["dump"], []), (["send"], ["0.2"]), (["bridge", "attach"], [BUS])):
            controller, line = pty.openpty()
            self.addCleanup(os.close, controller)
            self.addCleanup(os.close, line)

            def has_said_hello(process):
                self.assertTrue(select.select([controller], [], [], GUARD)[0])
                while select.select([controller], [], [], 0)[0]:
                    os.read(controller, 1000)

            self.ends(*before, "serial:" + os.ttyname(line), *after, opening=has_said_hello)

    def test_a_hub_that_is_stopped(self):
        hub = self.dump(BUS)
        hub.signal(signal.SIGSTOP)

        def is_connected(process):
            folder = f"/proc/{process.pid}/fd"
            deadline = time.monotonic() + GUARD
            while time.monotonic() < deadline:
                links = []
                for name in os.listdir(folder):
                    try:
                        links.append(os.readlink(os.path.join(folder, name)))
                    except FileNotFoundError:
                        pass
                if any(link.startswith("socket:") for link in links):
                    return
                time.sleep(0.001)
            self.fail("no connection")

        self.ends("dump", BUS, opening=is_connected)
        hub.signal(signal.SIGCONT)


class NobodyTest(CliTest):
    ALONE = "roio-cli: local:robot: nobody else was there to have "

    def test_is_told_once_and_is_no_error(self):
        self.assertEqual(self.run_cli("send", BUS, "0.2", "01"), (0, "", self.ALONE + "1 message\n"))
        self.assertEqual(self.run_cli("send", "--count", "100", BUS, "0.2", "01"),
                         (0, "", self.ALONE + "100 messages\n"))

    def test_who_only_sends_does_not_listen(self):
        other = subprocess.Popen([CLI, "send", BUS, "-"], stdin=subprocess.PIPE, text=True)
        while BUS not in self.run_cli("buses", env=dict(os.environ, ROIO_SERIAL_PORTS=""))[1]:
            time.sleep(0.01)
        self.assertEqual(self.run_cli("send", BUS, "0.2", "01"), (0, "", self.ALONE + "1 message\n"))
        other.communicate(timeout=GUARD)

    def test_who_waits_leaves_the_bus_to_the_listener(self):
        """Else the listener looks for another bus just when the next one sends."""
        for _ in range(20):
            listener = subprocess.Popen([CLI, "dump", "-n", "2", BUS], stdout=subprocess.PIPE, text=True)
            self.assertEqual(self.run_cli("send", "--wait", BUS, "0.2", "01"), (0, "", ""))
            self.assertEqual(self.run_cli("send", BUS, "0.2", "02"), (0, "", ""))
            out, _ = listener.communicate(timeout=GUARD)
            self.assertEqual([line[-2:] for line in out.splitlines()], ["01", "02"])

    def test_wait_ends_with_the_first_who_listens(self):
        sender = subprocess.Popen([CLI, "send", "--wait=600000", BUS, "0.2", "01"],
                                  stderr=subprocess.PIPE, text=True)
        dump = self.dump("-n", "1", BUS)
        self.assertEqual(dump.result(), (0, "0.10   -> 0.2     normal  message  [1]  01\n", ""))
        self.assertEqual(sender.communicate(timeout=GUARD), (None, ""))
        self.assertEqual(sender.returncode, 0)

    def test_wait_is_bounded_and_sends_nothing_then(self):
        self.assertEqual(
            self.run_cli("send", "--wait=20", BUS, "0.2", "01"),
            (1, "", "roio-cli: local:robot: nobody came to listen within 20 ms; nothing was sent\n"))

    def test_a_signal_ends_the_wait(self):
        sender = subprocess.Popen([CLI, "send", "--wait", BUS, "0.2", "01"],
                                  stderr=subprocess.PIPE, text=True)
        wait_until(lambda: catches(sender, signal.SIGINT))
        sender.send_signal(signal.SIGINT)
        self.assertEqual(sender.communicate(timeout=GUARD)[1].replace(
            "roio-cli: local:robot: 0 messages sent\n", ""), "")
        self.assertEqual(sender.returncode, 128 + signal.SIGINT)

    def test_pasted_forty_times_it_never_misses(self):
        pasted = (f'"{CLI}" dump -n 1 local:robot &\n'
                  f'"{CLI}" send --wait=60000 local:robot 0.2 5A2D00\n'
                  "wait\n")
        for number in range(40):
            done = subprocess.run(["bash", "-c", pasted], capture_output=True, text=True,
                                  timeout=2 * GUARD)
            self.assertEqual((done.returncode, done.stdout, done.stderr),
                             (0, "0.10   -> 0.2     normal  message  [3]  5A 2D 00\n", ""), number)


if __name__ == "__main__":
    main()
