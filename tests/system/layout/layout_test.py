"""Which part of the tree knows which, and how long files may be.

layout_test.py FOLDER             reads the #include lines below FOLDER, says what breaks a rule, ends with 1
layout_test.py FOLDER --self-test puts one line that breaks a rule into a copy, for each rule, and sees it found

A part is a folder, or some files (PARTS). It may include the standard library, the system's headers, its own files
and those of the parts that stand beside it in PARTS; nothing else of this project. Below the folders of RULED
every source has a part.

A source file has 450 lines at most, or a line in its head comment (its first 30 lines) that begins with
"Long, because" and says why.
"""
import re
import sys
from pathlib import Path

# Public headers are those below these folders: what a name in angle brackets means.
INCLUDE = {
    "core": "libroio/core/include",
    "host": "libroio/host/include",
    "parts": "libroio/host/include",
    "driver": "firmware/mcp2515/include",
    "sim": "sim/include",
    "arduino": "firmware/arduino/src",
}



def sim_headers(*names):
    return [f"sim/include/roio/sim/{name}.hpp" for name in names]


# Part: where its files are, and which parts it knows. The longest folder that fits is a file's part.
PARTS = {
    "core": (["libroio/core"], []),
    "driver": (["firmware/mcp2515"], ["core"]),
    # The host library: a backend's wing knows parts and text, never another wing.
    "host": (["libroio/host/include"], ["core"]),
    "parts": (["libroio/host/include/roio/parts", "libroio/host/include/roio/parts.hpp", "libroio/host/src/parts"],
              ["core", "host"]),
    "text": (["libroio/host/src/text"], ["core", "host"]),
    "local": (["libroio/host/src/local"], ["core", "host", "parts", "text"]),
    "serial": (["libroio/host/src/serial"], ["core", "host", "parts", "text"]),
    "socketcan": (["libroio/host/src/socketcan"], ["core", "host", "parts", "text"]),
    "json": (["libroio/host/src/json"], ["core", "host", "parts", "text"]),
    "robot": (["libroio/host/src/robot"], ["core", "host", "parts", "text"]),
    # Bus, Node, errors and open() stand above the wings.
    "top": (["libroio/host/src"], ["core", "host", "parts", "text", "local", "serial", "socketcan"]),
    # The simulator, as sim/CMakeLists.txt links it: a wing's public headers, and its own files.
    "sim bus": (sim_headers("can_bus", "controller", "host_node", "time"), ["core"]),
    "sim mcp2515": (sim_headers("mcp2515_chip", "spi_wire"), ["core", "sim bus"]),
    "sim network": (sim_headers("network"), ["core", "host", "sim bus", "sim mcp2515"]),
    "sim board": (sim_headers("board", "serial_pty"), ["core", "sim bus", "sim mcp2515"]),
    "sim/bus": (["sim/src/bus"], ["core", "sim bus"]),
    "sim/mcp2515": (["sim/src/mcp2515"], ["core", "sim bus", "sim mcp2515"]),
    "sim/network": (["sim/src/network"],
                    ["core", "driver", "host", "parts", "sim bus", "sim mcp2515", "sim network"]),
    "sim/avr": (["sim/src/avr"], ["core", "sim bus", "sim mcp2515", "sim board"]),
    "sim/board": (["sim/src/board"], ["core", "sim bus", "sim mcp2515", "sim board", "sim/avr"]),
    # Tools know public headers alone; roio-sim takes parts of roio-cli.
    "roio-cli": (["tools/roio-cli"], ["core", "host"]),
    "roio-sim": (["tools/roio-sim"],
                 ["core", "host", "sim bus", "sim mcp2515", "sim network", "sim board", "roio-cli"]),
}

# Names in angle brackets that say nothing about the tree: <vector>, <poll.h>, <sys/ioctl.h>, other libraries'.
OUR_NAME = re.compile(r"roio(\.hpp|/.*)|Roio\.h")
INCLUDE_LINE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.MULTILINE)

# Where every file has a part.
RULED = ("libroio/", "sim/", "firmware/mcp2515/", "tools/")

SOURCES = {".cpp", ".hpp", ".h", ".ino", ".py", ".sh"}
LONGEST = 450
HEAD = 30
REASON = re.compile(r"^[\s/*#\"]*Long, because \S", re.MULTILINE)
NOT_OURS = {"build", ".git", ".ci", ".cache"}


def part_of(name):
    """The part that a file belongs to; None: to none that has a rule."""
    fits = [(len(folder), part) for part, (folders, _) in PARTS.items() for folder in folders
            if name == folder or name.startswith(folder + "/")]
    return max(fits)[1] if fits else None


class Tree:
    def __init__(self, files):
        self.files = files  # text by name

    def target(self, name, quoted, included):
        """The file that an #include line means; None: not one of this project's."""
        places = []
        if quoted:
            places = [str(Path(name).parent)]
            places += ["libroio/host/src", "sim/src", "tools/roio-cli/src", "tools/roio-sim/src"]
        places += sorted(set(INCLUDE.values()))
        for place in places:
            if f"{place}/{included}" in self.files:
                return f"{place}/{included}"
        return None

    def broken_arrows(self):
        for name, text in sorted(self.files.items()):
            part = part_of(name)
            if part is None:
                if name.startswith(RULED) and name.endswith((".cpp", ".hpp", ".h")):
                    yield f"{name} belongs to no part of PARTS"
                continue
            for bracket, included in INCLUDE_LINE.findall(text):
                target = self.target(name, bracket == '"', included)
                if target is None:
                    if bracket == '"' or OUR_NAME.fullmatch(included):
                        yield f"{name} includes {included}, which is nowhere"
                    continue
                other = part_of(target)
                if other == part:
                    continue
                if other not in PARTS[part][1]:
                    yield f"{name} ({part}) includes {target} ({other or 'no part'}); {part} may know " \
                          f"{', '.join(PARTS[part][1]) or 'nobody'}"

    def circles(self):
        """Arrows that lead back, in PARTS itself."""
        def reaches(part, goal, seen):
            return any(other == goal or (other not in seen and reaches(other, goal, seen | {other}))
                       for other in PARTS[part][1])
        return (f"{part} knows itself by way of others" for part in PARTS if reaches(part, part, {part}))

    def too_long(self):
        for name, text in sorted(self.files.items()):
            lines = text.count("\n")
            head = "\n".join(text.split("\n")[:HEAD])
            if lines > LONGEST and not REASON.search(head):
                yield f'{name} has {lines} lines: {LONGEST} at most, or a line "Long, because ..." in its head comment'

    def complaints(self):
        return [*self.broken_arrows(), *self.circles(), *self.too_long()]


def read(folder):
    files = {}
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder)
        if path.suffix in SOURCES and not NOT_OURS & set(name.parts) and path.is_file():
            files[str(name)] = path.read_text(encoding="utf-8")
    # scripts have no suffix
    for path in sorted((folder / "scripts").iterdir()):
        if path.is_file() and not path.suffix:
            files[str(path.relative_to(folder))] = path.read_text(encoding="utf-8")
    return files


# A file, and the line that it must not have.
FORBIDDEN = [
    ("libroio/core/include/roio/frame.hpp", "#include <roio/bus.hpp>"),  # core knows nobody
    ("libroio/core/include/roio/frame.hpp", "#include <roio/mcp2515.hpp>"),
    ("firmware/mcp2515/include/roio/mcp2515.hpp", "#include <roio/bus.hpp>"),  # the driver knows core only
    ("firmware/mcp2515/include/roio/mcp2515.hpp", "#include <roio/arduino_port.hpp>"),
    ("libroio/host/include/roio/bus.hpp", "#include <roio/parts/waits.hpp>"),  # users need no parts
    ("libroio/host/include/roio/parts/waits.hpp", '#include "text/quote.hpp"'),  # parts know public headers
    ("libroio/host/src/parts/waits.cpp", '#include "local/hub.hpp"'),
    ("libroio/host/src/text/quote.hpp", "#include <roio/parts/waits.hpp>"),  # text knows no wing
    ("libroio/host/src/text/quote.hpp", '#include "serial/session.hpp"'),
    ("libroio/host/src/local/hub.cpp", '#include "serial/session.hpp"'),  # a wing, another wing
    ("libroio/host/src/serial/bus.cpp", '#include "socketcan/errors.hpp"'),
    ("libroio/host/src/socketcan/bus.cpp", '#include "local/hub.hpp"'),
    ("libroio/host/src/json/codec.cpp", '#include "local/hub.hpp"'),
    ("libroio/host/src/serial/bus.cpp", '#include "../local/hub.hpp"'),
    ("libroio/host/src/bus.cpp", '#include "json/fields.hpp"'),  # JSON is a library above
    ("libroio/host/src/bus.cpp", '#include "robot/exact.hpp"'),  # and robots
    ("libroio/host/src/robot/robot.cpp", '#include "json/fields.hpp"'),
    ("libroio/host/src/bus.cpp", "#include <roio/sim/time.hpp>"),
    ("sim/src/bus/can_bus.cpp", '#include "mcp2515/map.hpp"'),  # bus < mcp2515 < network, avr < board
    ("sim/include/roio/sim/can_bus.hpp", "#include <roio/sim/mcp2515_chip.hpp>"),
    ("sim/include/roio/sim/mcp2515_chip.hpp", "#include <roio/sim/board.hpp>"),
    ("sim/src/bus/can_bus.cpp", "#include <roio/sim/mcp2515_chip.hpp>"),
    ("sim/src/mcp2515/chip.cpp", '#include "bus/wire_bits.hpp"'),
    ("sim/src/mcp2515/chip.cpp", '#include "network/core.hpp"'),
    ("sim/src/mcp2515/chip.cpp", '#include "avr/core.hpp"'),
    ("sim/src/network/core.cpp", '#include "avr/core.hpp"'),
    ("sim/src/avr/core.cpp", '#include "board/pins.hpp"'),
    ("sim/src/avr/core.cpp", "#include <roio/bus.hpp>"),
    ("sim/src/board/board.cpp", '#include "network/core.hpp"'),
    ("tools/roio-cli/src/program/main.cpp", '#include "text/quote.hpp"'),  # tools know public headers
    ("tools/roio-cli/src/program/main.cpp", "#include <roio/sim/time.hpp>"),
    ("tools/roio-sim/src/main.cpp", '#include "board/pins.hpp"'),
    ("tools/roio-sim/src/main.cpp", "#include <roio/parts/waits.hpp>"),
    ("libroio/host/src/local/hub.cpp", '#include "local/no_such_file.hpp"'),  # and a typing mistake
    ("tools/roio-cli/src/program/main.cpp", "#include <roio/no_such_file.hpp>"),
]


def self_test(files):
    missed = []
    for name, line in FORBIDDEN:
        found = Tree({**files, name: line + "\n" + files[name]}).broken_arrows()
        if not any(complaint.startswith(name) for complaint in found):
            missed.append(f"{line} in {name} was not found")
    if not list(Tree({"sim/src/new/wing.cpp": ""}).broken_arrows()):
        missed.append("a new wing without a rule was not found")
    long_file = "x\n" * (LONGEST + 1)
    for name, text, is_fine in [
            ("a.cpp", "x\n" * LONGEST, True),
            ("a.cpp", long_file, False),
            ("a.sh", "# Long, because it is one table.\n" + long_file, True),
            ("a.py", '"""What it does.\n\nLong, because it is one table.\n"""\n' + long_file, True),
            ("a.cpp", "// Long, because\n" + long_file, False),
            ("a.cpp", "x\n" * HEAD + "// Long, because it is hidden.\n" + long_file, False)]:
        if is_fine == bool(list(Tree({name: text}).too_long())):
            missed.append(f"{name} of {text[:40]!r}... was not judged as meant: {is_fine}")
    PARTS["text"][1].append("local")
    if not list(Tree({}).circles()):
        missed.append("a circle in PARTS was not found")
    return missed


def main():
    folder = Path(sys.argv[1])
    files = read(folder)
    if not files:
        sys.exit(f"{folder}: no sources")
    complaints = self_test(files) if sys.argv[2:] == ["--self-test"] else Tree(files).complaints()
    print("\n".join(complaints) or f"{len(files)} files, as they should be")
    sys.exit(1 if complaints else 0)


main()
