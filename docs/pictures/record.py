#!/usr/bin/env python3
"""Records scripts/demo into demo.cast (asciicast v2), from which draw.py makes demo.svg.

usage: docs/pictures/record.py

Runs the real demo in a terminal of its own. Run it once before, so that the build is no part of the recording, and
on a machine that does nothing else: a recording in which the boards could not keep up is refused.
Two names that are new in each run are replaced, so that recordings can be compared: that of the serial line's
temporary file, and the number in the bus's name.
"""

import json
import os
import pathlib
import pty
import re
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
COLUMNS, ROWS = 100, 30


def stable(line):
    line = re.sub(r"/\S*/roio-demo\.\w+/ttyACM0", "/tmp/demo.ttyACM0", line)
    return re.sub(r"local:demo-\d+", "local:demo", line)


def record():
    """The demo's lines, each with the time at which it was complete, and the demo's exit status."""
    child, terminal = pty.fork()
    if child == 0:
        os.chdir(ROOT)
        os.environ.update(TERM="xterm", COLUMNS=str(COLUMNS), LINES=str(ROWS))
        os.execv("scripts/demo", ["scripts/demo"])
    start, text, lines = time.monotonic(), b"", []
    while True:
        try:
            read = os.read(terminal, 65536)
        except OSError:  # how Linux says that the terminal's other end is closed
            break
        text += read
        while b"\n" in text:
            line, _, text = text.partition(b"\n")
            lines.append((time.monotonic() - start, line.decode().rstrip("\r")))
    return lines, os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def main():
    if len(sys.argv) > 1:
        print(__doc__)
        return 0 if set(sys.argv[1:]) <= {"-h", "--help"} else 2
    lines, status = record()
    trouble = [line for _, line in lines if re.search(r"behind real time|: No such file", line)]
    if status or trouble:
        print(*[line for _, line in lines], sep="\n", file=sys.stderr)
        print(f"record.py: expected a demo that goes well, on a machine with time for it; got status {status}"
              + "".join(f", '{line.strip()}'" for line in trouble[:1]), file=sys.stderr)
        return 1
    header = {"version": 2, "width": COLUMNS, "height": ROWS, "title": "scripts/demo"}
    events = [[0.0, "o", "$ scripts/demo\r\n"]]
    events += [[round(when, 3), "o", stable(line) + "\r\n"] for when, line in lines]
    (HERE / "demo.cast").write_text("".join(json.dumps(row) + "\n" for row in [header, *events]), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
