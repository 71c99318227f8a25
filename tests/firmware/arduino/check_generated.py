#!/usr/bin/env python3
"""A generated header must not cost what bytes written by hand do not: usage: check_generated.py AVR_SIZE IMAGES
EXAMPLE BY_HAND

IMAGES is a board's folder with EXAMPLE.elf, which has its messages from a generated header, and BY_HAND.elf, which
does the same without. Fails when the first takes more flash or static RAM.
"""
import pathlib
import subprocess
import sys

program, images, example, by_hand = sys.argv[1:]


def size(name):
    """(flash, static RAM) in bytes."""
    image = pathlib.Path(images) / f"{name}.elf"
    if not image.exists():
        sys.exit(f"{image} is not there: it was not built, or does not build")
    lines = subprocess.run([program, image], check=True, capture_output=True, text=True).stdout.splitlines()
    text, data, bss = (int(word) for word in lines[1].split()[:3])
    return text + data, data + bss


with_header, without = size(example), size(by_hand)
for name, (flash, ram) in ((example, with_header), (by_hand, without)):
    print(f"{name:<16} {flash:>6} bytes of flash {ram:>6} of RAM")
if with_header[0] > without[0] or with_header[1] > without[1]:
    sys.exit(f"{example} is larger than {by_hand}")
