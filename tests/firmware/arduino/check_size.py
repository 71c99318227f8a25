#!/usr/bin/env python3
"""What a node costs beside a sketch that does nothing: usage: check_size.py AVR_SIZE IMAGES BUDGET...

IMAGES is a board's folder with Empty.elf and the sketches that BUDGETs name: SKETCH:FLASH:RAM, the most
bytes of flash and of static RAM that it may take more than Empty does. Says what each takes.
"""
import pathlib
import subprocess
import sys

program, images, *budgets = sys.argv[1:]


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
over_budget = []
print(f"{'beyond Empty':<16} {'flash':>6} {'at most':>8} {'RAM':>6} {'at most':>8}")
for budget in budgets:
    name, most_flash, most_ram = budget.split(":")
    flash, ram = size(name)
    over_flash, over_ram = flash - empty_flash, ram - empty_ram
    print(f"{name:<16} {over_flash:>6} {most_flash:>8} {over_ram:>6} {most_ram:>8}")
    if over_flash > int(most_flash) or over_ram > int(most_ram):
        over_budget.append(name)
if over_budget:
    sys.exit(f"over budget: {', '.join(over_budget)}")
