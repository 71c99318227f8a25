#!/usr/bin/env python3
"""What the bridge takes: usage: check_budget.py AVR_SIZE IMAGE MOST_FLASH MOST_RAM (bytes)"""
import subprocess
import sys

program, image, most_flash, most_ram = sys.argv[1:]
lines = subprocess.run([program, image], check=True, capture_output=True, text=True)
text, data, bss = (int(word) for word in lines.stdout.splitlines()[1].split()[:3])
flash, ram = text + data, data + bss
print(f"{flash} bytes of flash of at most {most_flash}, {ram} of static RAM of at most {most_ram}")
if flash > int(most_flash) or ram > int(most_ram):
    sys.exit("the bridge is over its budget")
