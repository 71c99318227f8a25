#!/usr/bin/env python3
"""What a node costs an Uno in flash and RAM: usage: sizes.py IMAGES

IMAGES is the folder with the images of a board, by tests/firmware/load/images.cmake and the examples.
Prints tables as bench/figures.md has them: each sketch beyond one that does nothing, and where Echo's
bytes are. Needs avr-size and avr-nm.
"""
import pathlib
import re
import subprocess
import sys

SKETCHES = [
    ("SizeSerialEcho", "Arduino's Serial echo, for scale"),
    ("Echo", "Echo"),
    ("EchoInterrupt", "Echo, interrupt pin"),
    ("EchoSetPin", "Echo, `Roio roio(10)`"),
    ("EchoClassic", "an echo in the calls of 2014"),
    ("EchoPortable", "Echo, portable pins"),
]
EMPTY = "SizeEmpty"


def run(*words):
    return subprocess.run([str(word) for word in words], check=True, capture_output=True,
                          text=True).stdout


def size(images, name):
    """(flash, static RAM) in bytes."""
    text, data, bss = (int(word) for word in
                       run("avr-size", images / f"{name}.elf").splitlines()[1].split()[:3])
    return text + data, data + bss


def functions(image):
    """{name: bytes} of what is in flash."""
    result = {}
    for line in run("avr-nm", "--demangle", "--print-size", image).splitlines():
        match = re.match(r"[0-9a-f]+ ([0-9a-f]+) [tTwWvV] (.*)", line)
        if match:
            result[short(match[2])] = result.get(short(match[2]), 0) + int(match[1], 16)
    return result


def short(name):
    """A function without its namespaces, template arguments, parameters and clones."""
    name = re.sub(r" \[clone [^]]*\]", "", name)
    name = re.sub(r"\([a-z ]+\)", "", name)  # (unsigned char)10
    while re.search(r"<[^<>]*>", name):
        name = re.sub(r"<[^<>]*>", "", name)
    name = re.sub(r"\(.*\)( const)?$", "", name)
    return name.replace("roio_library::", "")


def print_sizes(images, examples):
    empty_flash, empty_ram = size(images, EMPTY)
    print(f"sketch | flash | RAM, beyond the {empty_flash} and {empty_ram} bytes of an empty sketch")
    for name, title in SKETCHES + [(name, name) for name in examples]:
        flash, ram = size(images, name)
        print(f"| {title} | {flash - empty_flash:,} | {ram - empty_ram:,} |")


def print_functions(images):
    echo, empty = functions(images / "Echo.elf"), functions(images / f"{EMPTY}.elf")
    rest = size(images, "Echo")[0] - size(images, EMPTY)[0]
    print("function of Echo | bytes more than in an empty sketch")
    for name, count in sorted(echo.items(), key=lambda item: -item[1]):
        more = count - empty.get(name, 0)
        if more > 0:
            print(f"| {name} | {more} |")
            rest -= more
    print(f"| (the rest: vectors, clearing of RAM) | {rest} |")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    images = pathlib.Path(sys.argv[1])
    source = pathlib.Path(__file__).resolve().parents[2] / "firmware/arduino/examples"
    examples = sorted(path.name for path in source.iterdir() if path.name != "Echo")
    print_sizes(images, examples)
    print()
    print_functions(images)


main()
