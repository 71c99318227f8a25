#!/usr/bin/env python3
"""Draws the documents' pictures: each module here that has a function picture() makes one SVG beside it.

usage: docs/pictures/draw.py [--check] [NAME...]

  NAME     only these pictures: wiring-uno, bus, identifier, ...
  --check  draws nothing; says which SVG is not what its module would draw, and ends with 1 if any

The SVGs are in the repository because a forge shows them in README.md; tests check that they are fresh.
Needs Python 3 and nothing else.
"""

import importlib
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(HERE))

PICTURES = ("wiring-uno", "bus", "identifier", "overview", "bridge", "demo", "schematic", "board-plan")


def drawn(name):
    return str(importlib.import_module(name.replace("-", "_")).picture())


def main(arguments):
    if {"-h", "--help"} & set(arguments):
        print(__doc__)
        return 0
    check = "--check" in arguments
    names = [argument for argument in arguments if argument != "--check"] or PICTURES
    unknown = [name for name in names if name not in PICTURES]
    if unknown:
        print(f"draw.py: expected one of {', '.join(PICTURES)}; got '{unknown[0]}'", file=sys.stderr)
        return 2
    stale = 0
    for name in names:
        path = HERE / f"{name}.svg"
        before = path.read_text(encoding="utf-8") if path.exists() else None
        after = drawn(name)
        if before == after:
            continue
        if check:
            print(f"draw.py: {path.name} is stale: run docs/pictures/draw.py", file=sys.stderr)
            stale += 1
        else:
            path.write_text(after, encoding="utf-8")
            print(f"drew {path.name}")
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
