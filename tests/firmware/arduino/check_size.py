#!/usr/bin/env python3
"""What a node costs beside the serial port: usage: check_size.py AVR_SIZE IMAGES MOST_FLASH MOST_RAM

IMAGES is a board's folder with Empty.elf, SerialEcho.elf and Echo.elf. Fails when Echo takes more than
Empty by over MOST_FLASH bytes of flash or MOST_RAM bytes of static RAM.
"""
import pathlib
import subprocess
import sys

program, images, most_flash, most_ram = sys.argv[1:]


def size(name):
    """(flash, static RAM) in bytes."""
    image = pathlib.Path(images) / f"{name}.elf"
    if not image.exists():
        sys.exit(f"{image} is not there: it was not built, or does not build")
    lines = subprocess.run([program, image], check=True, capture_output=True,
                           text=True).stdout.splitlines()
    text, data, bss = (int(word) for word in lines[1].split()[:3])
    return text + data, data + bss


empty_flash, empty_ram = size("Empty")
print(f"{'sketch':<12} {'flash':>6} {'over Empty':>11} {'RAM':>6} {'over Empty':>11}")
for name in ("Empty", "SerialEcho", "Echo"):
    flash, ram = size(name)
    over_flash, over_ram = flash - empty_flash, ram - empty_ram
    print(f"{name:<12} {flash:>6} {over_flash:>11} {ram:>6} {over_ram:>11}")
print(f"{'at most':<12} {'':>6} {most_flash:>11} {'':>6} {most_ram:>11}")
if over_flash > int(most_flash) or over_ram > int(most_ram):
    sys.exit("Echo is over its budget")
