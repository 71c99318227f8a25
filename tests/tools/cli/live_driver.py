"""Programs that run while a test does other things: roio-cli's own commands, and a terminal by tmux."""

import os
import re
import shlex
import signal
import subprocess
import tempfile
import threading

from driver import CLI, GUARD, CliTest, wait_until


class Running:
    """A roio-cli that has said its first line on standard error: "listening", "attached to"."""

    def __init__(self, *arguments, env=None):
        self.process = subprocess.Popen([CLI, *arguments], stdin=subprocess.DEVNULL, text=True, env=env,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.guard = threading.Timer(2 * GUARD, self.process.kill)
        self.guard.daemon = True
        self.guard.start()
        self.first = self.process.stderr.readline()

    def end(self, number=None):
        """Exit status, output and errors, after a signal or by itself."""
        if number:
            self.process.send_signal(number)
        out, err = self.process.communicate(timeout=GUARD)
        return self.process.returncode, out, err

    def wait_for(self, text):
        """Reads standard error until a line is this, a regular expression."""
        for line in self.process.stderr:
            if re.fullmatch("roio-cli: " + text + "\n", line):
                return
        raise AssertionError("it ended without: " + text)


class LiveTest(CliTest):
    def running(self, *arguments, **options):
        running = Running(*arguments, **options)

        def end():
            running.guard.cancel()
            if running.process.poll() is None:
                running.process.send_signal(signal.SIGCONT)
                running.process.kill()
            running.process.communicate()

        self.addCleanup(end)
        return running


class Screen:
    """A terminal of a size, in which a shell command runs."""

    def __init__(self, test, command, columns=80, lines=24, **variables):
        # A socket of its own: a server that ends may still have its.
        self.socket = os.path.join(tempfile.mkdtemp(dir=test.folder), "tmux")
        env = {name: value for name, value in os.environ.items()
               if name not in ("NO_COLOR", "TMUX", "LD_PRELOAD")}
        env.update({"LC_ALL": "C.UTF-8", "SHELL": "/bin/sh"}, **variables)
        self.env = env
        test.addCleanup(self.close)
        self.tmux("new-session", "-d", "-x", str(columns), "-y", str(lines), command)

    def tmux(self, *arguments):
        done = subprocess.run(["tmux", "-S", self.socket, "-f", "/dev/null", *arguments], text=True,
                              capture_output=True, timeout=GUARD, env=self.env)
        if done.returncode != 0:
            raise AssertionError(f"tmux {shlex.join(arguments)}: {done.stderr}")
        return done.stdout

    def close(self):
        subprocess.run(["tmux", "-S", self.socket, "kill-server"], capture_output=True, timeout=GUARD)

    def keys(self, *names):
        self.tmux("send-keys", *names)

    def resize(self, columns, lines):
        self.tmux("resize-window", "-x", str(columns), "-y", str(lines))

    def lines(self, *options):
        return [line.rstrip() for line in self.tmux("capture-pane", "-p", *options).split("\n")[:-1]]

    def wait_for(self, pattern, *options):
        """Until a line has this in it; the whole screen then."""
        found = []

        def look():
            found[:] = self.lines(*options)
            return any(re.search(pattern, line) for line in found)

        try:
            wait_until(look)
        except AssertionError:
            raise AssertionError(f"never {pattern!r}; last:\n" + "\n".join(found)) from None
        return found
