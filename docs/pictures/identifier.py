"""The 29-bit identifier as boxes, with 0.10 -> 0.2 filled in. The fields are those of docs/protocol.md."""

import pathlib
import re

from kit import Picture

PROTOCOL = pathlib.Path(__file__).resolve().parent.parent / "protocol.md"
BIT, GAP, LEFT = 24, 20, 32
BOXES = 112  # the boxes' upper edge

# name in the protocol's table: (name in the picture, value here, what that means)
EXAMPLE = {"priority": ("prio", 1, "normal"), "class": ("class", 0, "message"),
           "destination subnet": ("dst subnet", 0, "0"), "destination node": ("dst address", 2, "2"),
           "source subnet": ("src subnet", 0, "0"), "source node": ("src address", 10, "10")}


def fields():
    """[(name, highest bit, lowest bit)], as the protocol's table has them."""
    table = PROTOCOL.read_text(encoding="utf-8").split("## Header")[1].split("\n## ")[0]
    rows = re.findall(r"(?m)^\| ([a-z ]+?) +\| (\d+)(?:\.\.(\d+))? +\|", table)
    found = [(name, int(high), int(low or high)) for name, high, low in rows]
    if [name for name, _, _ in found] != list(EXAMPLE) or found[0][1] != 28 or found[-1][2] != 0:
        raise ValueError(f"expected the six fields in {PROTOCOL.name}, \"Header\"; got {found}")
    return found


def identifier():
    value = 0
    for name, _, low in fields():
        value |= EXAMPLE[name][1] << low
    return value


def columns():
    """The left edge of each bit's box."""
    left, edges = LEFT, {}
    for name, high, low in fields():
        for bit in range(high, low - 1, -1):
            edges[bit] = left
            left += BIT
        left += GAP if name != "priority" else 2 * GAP  # room for what the narrowest field means
    return edges


def bracket(p, left, right, y, depth, style="thin"):
    p.line([(left, y + depth), (left, y), (right, y), (right, y + depth)], style)


def picture():
    value = identifier()
    p = Picture(880, 332, "The 29-bit identifier of a message from 0.10 to 0.2",
                "Six fields, the highest bit first: priority 1, normal; class 00, message; destination subnet 00000 and "
                "address 00000010, that is 0.2; source subnet 00000 and address 00001010, that is 0.10. "
                f"Read as one number they are {value:08X}.")
    edge = columns()
    spans = {name: (edge[high], edge[low] + BIT) for name, high, low in fields()}
    for first, last, words in (("destination subnet", "destination node", "to 0.2"),
                               ("source subnet", "source node", "from 0.10")):
        left, right = spans[first][0], spans[last][1]
        p.text((left + right) / 2, 28, words, "bold accent big", "middle")
        bracket(p, left, right, 44, 8, "hot")
    for name, high, low in fields():
        label, number, meaning = EXAMPLE[name]
        left, right = spans[name]
        p.text((left + right) / 2, 72, label, "bold", "middle")
        p.text(edge[high] + BIT / 2, 96, str(high), "small muted mono", "middle")
        if low != high:
            p.text(edge[low] + BIT / 2, 96, str(low), "small muted mono", "middle")
        p.box(left, BOXES, right - left, 36, "tint", 4)
        for bit in range(high, low - 1, -1):
            if bit != high:
                p.line([(edge[bit], BOXES + 4), (edge[bit], BOXES + 32)], "thin")
            p.text(edge[bit] + BIT / 2, BOXES + 18, str(value >> bit & 1), "mono bold", "middle")
        p.text((left + right) / 2, 168, meaning, "", "middle")
    for nibble in range(7, -1, -1):
        low = 4 * nibble
        left, right = edge[min(low + 3, 28)], edge[low] + BIT
        bracket(p, left + 4, right - 4, 200, -8)
        p.text((left + right) / 2, 220, f"{value >> low & 15:X}", "mono bold accent big", "middle")
    p.lines(440, 264, [(f"0x{value:08X}, with 8 data bytes or fewer after it: one CAN frame", "bold"),
                       ("Of several that wait, the smallest identifier goes first: urgent (0) before normal (1).", "muted")],
            anchor="middle", step=32)
    return p
